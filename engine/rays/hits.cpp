#include "rays/hits.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <numeric>
#include <tuple>

#include "base/error.h"

namespace shadowbench::rays {
namespace {

// Finds the offsets of each ray's hits by counting; `begin` has rays + 1 entries.
template <class Hits>
void count(const Hits& hits, std::size_t rays, std::vector<std::uint32_t>& begin) {
    check_hits(hits);
    begin.assign(rays + 1, 0);
    for (const auto& hit : hits.hits) ++begin[hit.ray + 1];
    for (std::size_t r = 0; r < rays; ++r) begin[r + 1] += begin[r];
}

// Most rays cross little, so insertion sorts them. Long lists, such as the steps of a volume, are often sorted already.
template <class T, class Less>
void sort_ray(T* first, T* last, Less less) {
    if (last - first > 24) {
        if (!std::is_sorted(first, last, less)) std::sort(first, last, less);
        return;
    }
    for (T* i = first + (first != last); i < last; ++i) {
        const T value = *i;
        T* j = i;
        for (; j > first && less(value, j[-1]); --j) *j = j[-1];
        *j = value;
    }
}

// `found` holds the hits ray after ray; each ray's hits are in the order in which they were found.
template <class T, class Less>
void find_submission(const std::vector<T>& found, Less less, LightRays& tile) {
    tile.submission.resize(found.size());
    std::vector<std::uint32_t> sorted;
    for (std::size_t r = 0; r + 1 < tile.begin.size(); ++r) {
        const std::uint32_t first = tile.begin[r], count = tile.begin[r + 1] - first;
        sorted.resize(count);
        std::iota(sorted.begin(), sorted.end(), first);
        std::stable_sort(sorted.begin(), sorted.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return less(found[a], found[b]); });
        for (std::uint32_t place = 0; place < count; ++place) tile.submission[sorted[place]] = first + place;
    }
}

// Whether they are in order as they are: ray after ray, each from front to back, none at one depth.
bool are_sorted(const std::vector<SegmentHits::Hit>& hits) {
    for (std::size_t h = 1; h < hits.size(); ++h)
        if (hits[h].ray < hits[h - 1].ray ||
            (hits[h].ray == hits[h - 1].ray && !(hits[h].z_front > hits[h - 1].z_front)))
            return false;
    return true;
}

}  // namespace

void refuse_hits() {
    throw base::Error(base::ErrorCode::bad_input, "/rays",
                      "a tile of the map holds more than 2^28 segments: use fewer samples a pixel, larger steps "
                      "of the volumes, or fewer objects");
}

void sort_hits(const SurfaceHits& hits, std::size_t rays, bool submission, LightRays& tile) {
    count(hits, rays, tile.begin);
    // Depths are not negative, so their bits sort as they do; the transmittance behind breaks ties.
    thread_local std::vector<std::uint64_t> keys;
    keys.resize(hits.hits.size());
    std::vector<std::uint32_t> next(tile.begin.begin(), tile.begin.end() - 1);
    for (const auto& hit : hits.hits)
        keys[next[hit.ray]++] = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(hit.z)) << 32 |
                                std::bit_cast<std::uint32_t>(hit.transmittance);
    if (submission) find_submission(keys, std::less<>(), tile);
    for (std::size_t r = 0; r < rays; ++r)
        sort_ray(keys.data() + tile.begin[r], keys.data() + tile.begin[r + 1], std::less<>());
    tile.z_front.resize(keys.size());
    tile.z_back.clear();
    tile.transmittance.resize(keys.size());
    for (std::size_t s = 0; s < keys.size(); ++s) {
        tile.z_front[s] = std::bit_cast<float>(static_cast<std::uint32_t>(keys[s] >> 32));
        tile.transmittance[s] = std::bit_cast<float>(static_cast<std::uint32_t>(keys[s]));
    }
}

void sort_hits(const SegmentHits& hits, std::size_t rays, bool submission, LightRays& tile) {
    count(hits, rays, tile.begin);
    const bool in_order = are_sorted(hits.hits);  // as the hits of one volume
    thread_local std::vector<SegmentHits::Hit> scattered;
    const auto key = [](const SegmentHits::Hit& h) {
        return std::tie(h.z_front, h.z_back, h.transmittance[0], h.transmittance[1], h.transmittance[2]);
    };
    const auto less = [&](const SegmentHits::Hit& a, const SegmentHits::Hit& b) { return key(a) < key(b); };
    if (!in_order) {
        scattered.resize(hits.hits.size());
        std::vector<std::uint32_t> next(tile.begin.begin(), tile.begin.end() - 1);
        for (const auto& hit : hits.hits) scattered[next[hit.ray]++] = hit;
    }
    const std::vector<SegmentHits::Hit>& sorted = in_order ? hits.hits : scattered;
    if (submission) find_submission(sorted, less, tile);
    for (std::size_t r = 0; r < rays && !in_order; ++r)
        sort_ray(scattered.data() + tile.begin[r], scattered.data() + tile.begin[r + 1], less);
    bool media = false;
    for (const auto& hit : sorted) media |= hit.z_back > hit.z_front;

    const std::size_t channels = tile.channels;
    tile.z_front.resize(sorted.size());
    tile.z_back.resize(media ? sorted.size() : 0);
    tile.transmittance.resize(sorted.size() * channels);
    for (std::size_t s = 0; s < sorted.size(); ++s) {
        tile.z_front[s] = sorted[s].z_front;
        if (media) tile.z_back[s] = sorted[s].z_back;
        for (std::size_t c = 0; c < channels; ++c) tile.transmittance[s * channels + c] = sorted[s].transmittance[c];
    }
}

}  // namespace shadowbench::rays
