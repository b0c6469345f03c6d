#include "base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

namespace shadowbench::base {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    tbb::parallel_for(std::size_t{0}, count, body);
}

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

struct ThreadLimit::Control {
    explicit Control(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
    tbb::global_control control;  // must stay where it was made: a copy limits nothing
};

ThreadLimit::ThreadLimit(int threads) {
    const int count = threads > 0 ? threads : tbb::info::default_concurrency();
    control_ = std::make_unique<Control>(static_cast<std::size_t>(count));
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace shadowbench::base
