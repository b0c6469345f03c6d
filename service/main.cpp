#include <csignal>
#include <iostream>

#include <sys/prctl.h>

#include "service/cli/cli.h"

int main(int argc, char** argv) {
    // A server starts this program by a file descriptor, whose number would be its name in lists of processes.
    ::prctl(PR_SET_NAME, "shadowbench");
    std::signal(SIGCHLD, SIG_DFL);  // whoever ignores it does not learn how a child ended
    return shadowbench::service::cli_main(argc, argv, std::cout, std::cerr);
}
