#include "service/http/client_fault.h"

#include <netdb.h>
#include <sys/socket.h>

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/sslerr.h>
#include <openssl/x509_vfy.h>

namespace shadowbench::service {

bool is_unknown_host(const std::string& host) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int fault = ::getaddrinfo(host.c_str(), nullptr, &hints, &found);
    if (fault == 0) ::freeaddrinfo(found);
    return fault == EAI_NONAME || fault == EAI_NODATA;
}

std::optional<std::string> tls_fault() {
    // The first one: what follows it comes from closing the connection.
    while (const unsigned long fault = ERR_get_error()) {
        const int reason = ERR_GET_REASON(fault);
        if (ERR_GET_LIB(fault) != ERR_LIB_SSL || reason == SSL_R_UNEXPECTED_EOF_WHILE_READING ||
            reason == SSL_R_SHUTDOWN_WHILE_IN_INIT)
            continue;
        const char* text = ERR_reason_error_string(fault);
        return text ? text : fmt::format("fault {:x}", fault);
    }
    return std::nullopt;
}

void forget_tls_faults() {
    ERR_clear_error();
}

std::string certificate_fault(long verdict, const std::string& host) {
    if (verdict == X509_V_OK) return fmt::format("its certificate is not for {}; use the name that it is for", host);
    return fmt::format("its certificate is not trusted: {}; give --cacert the file of its authority, or mend it",
                       X509_verify_cert_error_string(verdict));
}

}  // namespace shadowbench::service
