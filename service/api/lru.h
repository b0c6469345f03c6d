// A cache that keeps the values used last.
#pragma once

#include <cstddef>
#include <list>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

namespace shadowbench::service {

// Keeps at most `most` values. Not thread-safe.
template <class Value>
class Lru {
public:
    explicit Lru(std::size_t most) : most_(most) {}

    Value* find(const std::string& key) {
        const auto found = places_.find(key);
        if (found == places_.end()) return nullptr;
        order_.splice(order_.begin(), order_, found->second);
        return &found->second->second;
    }

    void put(const std::string& key, Value value) {
        erase(key);
        order_.emplace_front(key, std::move(value));
        places_[key] = order_.begin();
        if (order_.size() <= most_) return;
        places_.erase(order_.back().first);
        order_.pop_back();
    }

    void erase(const std::string& key) {
        const auto found = places_.find(key);
        if (found == places_.end()) return;
        order_.erase(found->second);
        places_.erase(found);
    }

    std::size_t size() const { return order_.size(); }

private:
    using Order = std::list<std::pair<std::string, Value>>;  // last used first
    std::size_t most_;
    Order order_;
    std::unordered_map<std::string, typename Order::iterator> places_;
};

}  // namespace shadowbench::service
