// Faults of a client's connection that no other try would mend.
#pragma once

#include <optional>
#include <string>

namespace shadowbench::service {

// Whether the name service knows that there is no such host; it may also fail to answer. `host`: a name or a number.
bool is_unknown_host(const std::string& host);

// What OpenSSL noted against the other side in this thread since forget_tls_faults(). Nothing where the connection was
// cut or took too long.
std::optional<std::string> tls_fault();
void forget_tls_faults();

// The fault of a certificate, with its remedy. `verdict`: OpenSSL's, X509_V_OK where only the name is wrong.
std::string certificate_fault(long verdict, const std::string& host);

}  // namespace shadowbench::service
