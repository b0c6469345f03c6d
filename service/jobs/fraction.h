// Estimates how much of a job is done.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "bench/progress.h"

namespace shadowbench::service {

// The fraction of a job that is done, in [0, 1], from the stages of its progress. Each stage has a share of the time
// that is typical of scenarios. The fraction never decreases.
class JobFraction {
public:
    // `lights`: number of lights that are measured, in all variants. `pictured`: number of lights of the pictures that
    // are rendered afterwards; 0: no pictures.
    JobFraction(std::size_t lights, std::size_t pictured);

    double measuring(const bench::Progress& progress);  // progress of bench::run
    double picturing(const bench::Progress& progress);  // progress of render::render

private:
    struct Stage {
        const char* name;
        double share;
    };
    static const Stage measuring_stages[], picturing_stages[];
    // Measuring, or rendering: the same stages for each light.
    struct Part {
        std::span<const Stage> stages;
        std::size_t lights, light = 0;
        std::string place = {};
        bool begun = false;
        double done(const bench::Progress& progress);
    };

    Part measured_, pictured_;
    double measured_share_;
    double fraction_ = 0.0;
};

}  // namespace shadowbench::service
