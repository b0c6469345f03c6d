// A technique for tests: every pixel stores the same function, right or wrong.
#pragma once

#include <array>
#include <atomic>
#include <limits>
#include <memory>

#include "techniques/technique.h"

namespace shadowbench::bench {

struct FakeAnswers {
    curves::Curve function;  // of every pixel
    float lookup = 1.0f;     // the answer to every query
    int lines = 0;           // that a lookup reads, at most 16
    bool refuses_begin = false;
    techniques::Promises promises = {};
    double error_bound = 0.01;  // of curves
};

class FakeMap final : public techniques::Map {
public:
    explicit FakeMap(FakeAnswers answers) : answers_(std::move(answers)) {}

    void begin(const techniques::BuildInput& input) override;
    void add(const rays::LightRays&) override {}
    void finish() override {}
    void lookup(std::span<const techniques::Query>, std::span<float> visibility) const override {
        ++lookups_;
        for (float& v : visibility) v = answers_.lookup;
    }
    void touched(const techniques::Query&, std::vector<const void*>& lines) const override {
        for (int i = 0; i < answers_.lines; ++i) lines.push_back(memory_.data() + 64 * i);
    }
    int lookups() const { return lookups_; }  // calls so far
    std::size_t bytes() const override { return 100; }
    std::size_t working_bytes() const override { return 200; }
    techniques::NodeStats nodes() const override {
        techniques::NodeStats stats;
        stats.add(static_cast<std::uint32_t>(answers_.function.size()));
        return stats;
    }
    techniques::Cells cells() const override { return techniques::Cells::pixel; }
    void stored(int, int, int, std::span<const float>, curves::Curve& out) const override { out = answers_.function; }

private:
    FakeAnswers answers_;
    std::array<unsigned char, 1024> memory_{};
    mutable std::atomic<int> lookups_ = 0;
};

// The map that fake_technique() makes; tests change it.
inline FakeAnswers fake_answers;

// A row with the promises in the answers: by default all of them, and a curve error of at most 0.01.
const techniques::Technique& fake_technique();

}  // namespace shadowbench::bench
