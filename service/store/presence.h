// Notices that files and folders are gone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace shadowbench::service {

// A program that has a file open can go on writing to it after it was removed: what it writes is lost. So a server asks
// this before it promises to keep something. Thread-safe.
class Presence {
public:
    // Notes what is at these places now. Throws Error{io} where there is nothing.
    explicit Presence(const std::vector<std::filesystem::path>& places);

    // The first of the places where nothing is any more, or something else; nothing: all are as they were.
    std::optional<std::filesystem::path> gone() const;
    void check() const;  // throws Error{io} for that place

private:
    struct Noted {
        std::filesystem::path place;
        std::uint64_t device, inode;
    };
    std::vector<Noted> noted_;
};

}  // namespace shadowbench::service
