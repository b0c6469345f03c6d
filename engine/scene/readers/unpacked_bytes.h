// The bytes of a file from some place on, unpacked on the way if they are packed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/readers/file_reader.h"

struct z_stream_s;  // of zlib

namespace shadowbench::scene {

// deflate: gzip or zlib, told apart by their first bytes. Gzip files may have several members.
enum class Packing { none, deflate };

class UnpackedBytes {
public:
    // Keeps a reference to the file. The bytes begin at byte `begin` of it.
    UnpackedBytes(FileReader& file, std::uint64_t begin, Packing packing);
    ~UnpackedBytes();
    UnpackedBytes(const UnpackedBytes&) = delete;
    UnpackedBytes& operator=(const UnpackedBytes&) = delete;

    // How many bytes were read or passed.
    std::uint64_t position() const { return position_; }

    // Throws Error{bad_input} if the rest of the file cannot hold that many bytes, however well it is packed: for use
    // before memory is allocated for them. `what` names them.
    void need(std::uint64_t bytes, const char* what) const;

    // Both throw Error{bad_input} if the file ends first or is damaged.
    void read(std::span<std::uint8_t> to, const char* what);
    void pass(std::uint64_t bytes, const char* what);

    // Whether nothing follows; asked once, after all reading. Also checks the sum at the end of what is packed.
    bool at_end();

    // Throws Error{bad_input} at one of these bytes.
    [[noreturn]] void fail(std::uint64_t position, const std::string& message) const;

private:
    // Returns fewer bytes than asked for at the end only.
    std::size_t read_some(std::span<std::uint8_t> to);
    std::size_t inflate_some(std::span<std::uint8_t> to);
    bool refill();
    bool next_member();

    FileReader& file_;
    std::uint64_t begin_;
    std::unique_ptr<z_stream_s> stream_;  // null: not packed
    std::vector<std::uint8_t> packed_;    // what the stream reads from
    bool ended_ = false;                  // the stream
    std::uint64_t position_ = 0;
};

// The number of unpacked bytes that the end of a gzip file states; right below 4 GiB and for files of one member.
std::uint64_t gzip_bytes(const std::filesystem::path& file);

// All that a gzip file of one member unpacks to. Throws Error{bad_input} if it is damaged or goes on after that member.
std::string unpacked_file(const std::filesystem::path& file);

}  // namespace shadowbench::scene
