#include "service/jobs/storage_wait.h"

#include <fmt/format.h>

#include "base/error.h"
#include "service/jobs/room.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

}  // namespace

StorageAlarm::~StorageAlarm() {
    if (begun_ && place_.board.end_storage_fault() && !place_.board.stopping())
        place_.news.storage("the state folder can be written again; jobs go on");
}

void StorageAlarm::begin(const std::string& why) {
    if (!begun_ && place_.board.begin_storage_fault())
        place_.news.storage("the state folder cannot be written; jobs wait until it can: " + why);
    begun_ = true;
}

bool is_low(const Workplace& place, std::uintmax_t own) {
    const auto left = free_bytes(place.folders.work);
    return left && *left + own < place.limits.min_free;
}

void check_storage(const Workplace& place) {
    place.presence.check();
    const auto left = free_bytes(place.folders.work);
    if (left && *left < place.limits.min_free)
        throw Error(ErrorCode::io, place.folders.work.string(),
                    fmt::format("{} MiB of the disk are free, and --min-free asks for {}", *left >> 20,
                                place.limits.min_free >> 20));
    place.reserve.take();
}

void wait_for_room(const Workplace& place, const StoredJob& job, const Waits& waits, Patience& patience) {
    StorageAlarm alarm(place);
    alarm.begin(job.id + ": " + waits.why);
    const auto in_queue = [&] {
        try {
            const std::optional<StoredJob> now = place.store.find(job.id);
            return now && now->state == job_states::queued;
        } catch (const Error&) {
            return true;
        }
    };
    const auto may_start = [&] { return !is_low(place) && has_room(place.folders.work, waits.bytes + least_room); };
    do {
        patience.wait(place.board);
    } while (!place.board.stopping() && in_queue() && !may_start());
}

}  // namespace shadowbench::service
