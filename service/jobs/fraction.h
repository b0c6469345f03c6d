#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "bench/progress.h"

namespace shadowbench::service {

// How much of a job is done, told from the stages that pass. The stages' shares of the time are those of a typical
// scenario. What it answers never falls.
class JobFraction {
public:
    // `lights`: that are measured, summed over the variants. `pictured`: lights of the pictures that follow; 0: none.
    JobFraction(std::size_t lights, std::size_t pictured);

    double measuring(const bench::Progress& progress);  // of bench::run
    double picturing(const bench::Progress& progress);  // of render::render

private:
    struct Stage {
        const char* name;
        double share;
    };
    static const Stage measuring_stages[], picturing_stages[];
    // One of the two parts of the work: the same stages for one light after the other.
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
