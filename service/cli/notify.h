// Tells systemd how the server is (sd_notify, protocol of the environment variable NOTIFY_SOCKET).
#pragma once

#include <string>

namespace shadowbench::service {

// Sends a state, such as "READY=1", or several in lines. No effect where nobody listens.
void notify_manager(const std::string& state);

}  // namespace shadowbench::service
