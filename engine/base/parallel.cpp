#include "base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_group.h>

#ifdef __SANITIZE_THREAD__
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace shadowbench::base {

#ifdef __SANITIZE_THREAD__
// The thread sanitizer does not see the synchronisation inside the TBB library, which is built without it, and would
// report every hand-over of work as a race. Under it, loops run on plain threads.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr error;
    std::mutex mutex;
    const auto work = [&] {
        for (std::size_t i; (i = next++) < count;) {
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!error) error = std::current_exception();
                next = count;
            }
        }
    };
    std::vector<std::thread> others;
    const std::size_t threads = std::min(count, static_cast<std::size_t>(thread_count()));
    for (std::size_t t = 1; t < threads; ++t) others.emplace_back(work);
    work();
    for (std::thread& thread : others) thread.join();
    if (error) std::rethrow_exception(error);
}
#else
// By default a task rounds as the first thread did that gave TBB work. That may be Embree, which flushes denormal floats
// to zero: then numbers would depend on what ran before.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    using Context = tbb::task_group_context;
    Context as_this_thread(Context::bound, Context::default_traits | Context::fp_settings);
    tbb::parallel_for(std::size_t{0}, count, body, as_this_thread);
}
#endif

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

int library_threads() {
#ifdef __SANITIZE_THREAD__
    return 1;
#else
    return thread_count();
#endif
}

struct ThreadLimit::Control {
    explicit Control(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
    tbb::global_control control;  // must not move: a copy limits nothing
};

ThreadLimit::ThreadLimit(int threads) {
    const int count = threads > 0 ? threads : tbb::info::default_concurrency();
    control_ = std::make_unique<Control>(static_cast<std::size_t>(count));
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace shadowbench::base
