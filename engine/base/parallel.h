// Parallel loops over oneTBB. Results must not depend on the order of iterations.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace shadowbench::base {

// Calls body(i) for every i in [0, count), on up to thread_count() threads. The first exception is rethrown here.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

// Threads that parallel_for uses now.
int thread_count();

// Threads that a library which brings its own should start: as many; 1 under the thread sanitizer, which does not see
// how libraries that were built without it hand work over.
int library_threads();

// Limits parallel_for to `threads` (0: all processors) while it lives.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    struct Control;
    std::unique_ptr<Control> control_;
};

}  // namespace shadowbench::base
