#include <iostream>

#include "service/cli/cli.h"

int main(int argc, char** argv) {
    return shadowbench::service::cli_main(argc, argv, std::cout, std::cerr);
}
