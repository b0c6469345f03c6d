// Finds the file of this program, to run it again.
#pragma once

#include <string>

namespace shadowbench::service {

// The path of its file when it started. Throws Error{io}.
std::string this_program();

// Holds the file of this program open: path() starts this program even when the file was replaced or removed.
class HeldProgram {
public:
    HeldProgram();  // throws Error{io}
    ~HeldProgram();
    HeldProgram(const HeldProgram&) = delete;
    HeldProgram& operator=(const HeldProgram&) = delete;

    // A path to execute, for this process and its children.
    std::string path() const;

private:
    int descriptor_;
};

}  // namespace shadowbench::service
