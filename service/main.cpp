#include <csignal>
#include <iostream>
#include <string_view>

#include <sys/prctl.h>

#include "service/cli/cli.h"
#include "service/images/images.h"

int main(int argc, char** argv) {
    // A server starts this program by a file descriptor, whose number would be its name in lists of processes.
    ::prctl(PR_SET_NAME, "shadowbench");
    std::signal(SIGCHLD, SIG_DFL);  // whoever ignores it does not learn how a child ended
    if (argc > 1 && std::string_view(argv[1]) == "serve") shadowbench::service::hold_images();
    return shadowbench::service::cli_main(argc, argv, std::cout, std::cerr);
}
