// Space that a server keeps on the disk of its state folder. On a full disk it gives it up, so that it can start, and
// cancel and remove jobs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>

namespace shadowbench::service {

inline constexpr std::uintmax_t reserve_bytes = std::uintmax_t{256} << 10;

// A file without content. Thread-safe.
class Reserve {
public:
    // Gives up what an earlier server kept, if there is no room in the folder `work` for a start.
    Reserve(std::filesystem::path file, const std::filesystem::path& work);

    void take();     // where the disk has plenty of space; does nothing elsewhere
    bool give_up();  // returns whether there was any

private:
    std::filesystem::path file_;
    std::mutex mutex_;
    bool taken_ = false;
};

}  // namespace shadowbench::service
