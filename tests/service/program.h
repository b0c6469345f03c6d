// A process that a test starts.
#pragma once

#include <fcntl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <vector>

namespace shadowbench::service {

// A process that is ended with the test.
class Program {
public:
    // `input`: the file that it reads; empty: as the test does.
    Program(std::vector<std::string> words, const std::string& output, const std::string& input = "") {
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        process_ = ::fork();
        if (process_ != 0) return;
        if (!input.empty()) ::dup2(::open(input.c_str(), O_RDONLY | O_CLOEXEC), 0);
        const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
        ::dup2(file, 1);
        ::dup2(file, 2);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ~Program() {
        if (process_ > 0) ::kill(process_, SIGTERM);
        wait();
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    int wait() {
        if (process_ <= 0) return -1;
        int status = 0;
        ::waitpid(process_, &status, 0);
        process_ = 0;
        return status;
    }

private:
    pid_t process_ = 0;
};

}  // namespace shadowbench::service
