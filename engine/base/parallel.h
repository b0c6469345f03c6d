// Parallel loops over oneTBB. Results must not depend on the order of iterations.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace shadowbench::base {

// Calls body(i) for every i in [0, count), on up to thread_count() threads. Rethrows the first exception.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

// The number of threads that parallel_for uses now.
int thread_count();

// The number of threads that a library with threads of its own should start: thread_count(), but 1 under the thread
// sanitizer, which does not see the synchronisation of libraries that were built without it.
int library_threads();

// Limits parallel_for to `threads` threads (0: all processors) while it lives.
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
