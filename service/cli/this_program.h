// The program that runs, for what has to be run by it again.
#pragma once

#include <string>

namespace shadowbench::service {

// Where its file is, or was when it started. Throws Error{io}.
std::string this_program();

// Its file, held open: what `path` starts is this program, whatever has become of the file's name since.
class HeldProgram {
public:
    HeldProgram();  // throws Error{io}
    ~HeldProgram();
    HeldProgram(const HeldProgram&) = delete;
    HeldProgram& operator=(const HeldProgram&) = delete;

    // For a child to execute; it means the same in every child that has not closed what this process holds open.
    std::string path() const;

private:
    int descriptor_;
};

}  // namespace shadowbench::service
