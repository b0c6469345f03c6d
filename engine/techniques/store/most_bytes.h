// What a map under construction holds beside the map itself.
#pragma once

#include <atomic>
#include <cstddef>

namespace shadowbench::techniques {

// The most scratch memory that one tile took, in bytes. It does not depend on the number of threads. Thread-safe.
class MostBytes {
public:
    void add(std::size_t bytes) {
        std::size_t most = most_.load();
        while (bytes > most && !most_.compare_exchange_weak(most, bytes)) {
        }
    }
    std::size_t value() const { return most_.load(); }

private:
    std::atomic<std::size_t> most_ = 0;
};

}  // namespace shadowbench::techniques
