#include "service/store/store_kind.h"

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "base/error.h"

namespace shadowbench::service {

// The header of an SQLite file: its first 16 bytes are fixed, and application_id stands at 68, big endian
// (sqlite.org/fileformat2.html, 1.3).
StoreKind kind_of_store(const std::filesystem::path& file) {
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(file, failed);
    if (failed == std::errc::no_such_file_or_directory || (!failed && size == 0)) return StoreKind::none;
    std::array<char, 72> head{};
    std::ifstream stream(file, std::ios::binary);
    stream.read(head.data(), head.size());
    if (failed || stream.bad() || (!stream && !stream.eof()))
        throw base::Error(base::ErrorCode::io, file.string(), "the database cannot be read");
    if (!stream || std::string_view(head.data(), 16) != std::string_view("SQLite format 3\0", 16))
        return StoreKind::no_database;
    std::uint32_t id = 0;
    for (std::size_t i = 68; i < 72; ++i) id = id << 8 | static_cast<unsigned char>(head[i]);
    return id == static_cast<std::uint32_t>(store_application) ? StoreKind::ours : StoreKind::another_programs;
}

}  // namespace shadowbench::service
