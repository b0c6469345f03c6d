// Open files that are closed with their owner, and by exec().
#pragma once

namespace shadowbench::service {

class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }  // -1: closed
    void reset(int number);                 // closes what it had
    void close() { reset(-1); }

private:
    int number_;
};

// What is written to one end is read from the other. Throws Error{io}.
struct Pipe {
    Pipe();
    Descriptor read, write;
};

}  // namespace shadowbench::service
