// What one owner of jobs may have at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace shadowbench::service {

// Nothing: no limit.
struct OwnerLimits {
    std::optional<std::size_t> queued = {}, running = {};  // jobs
    std::optional<std::uint64_t> bytes = {};               // of results
};

using LimitsByOwner = std::map<std::string, OwnerLimits>;  // an owner that it lacks has no limits

inline OwnerLimits limits_of(const LimitsByOwner& limits, const std::string& owner) {
    const auto found = limits.find(owner);
    return found == limits.end() ? OwnerLimits{} : found->second;
}

}  // namespace shadowbench::service
