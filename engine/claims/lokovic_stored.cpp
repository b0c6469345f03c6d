// Lokovic and Veach, Deep Shadow Maps, 2000: sections 5.2 and 5.5.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "claims/lokovic.h"
#include "claims/seeded_light.h"

namespace shadowbench::claims::lokovic {
using results::Cell;

void channels(const Context& context) {
    PaperReport& report = *context.report;
    const std::string deep = set_techniques(pixels), seeds = "reference.spread_seeds=2";
    const results::Result grey = context.run(hair_ball, {deep}, {"rays.resolution=128"});
    const results::Result colour =
        context.run(hair_ball, {"/scene/objects/0/opacity=[0.9,0.6,0.35]", seeds, deep}, {"rays.resolution=128"});
    const results::Result one_channel =
        context.run(hair_ball, {"/scene/objects/0/opacity=0.6", seeds, deep}, {"rays.resolution=128"});
    const Cell &three = cell_of(light_of(colour), "deep"), &single = cell_of(light_of(one_channel), "deep");
    const Value size = bytes_of(three) / bytes_of(single);
    report.claims.push_back({"section 5.2",
                             "three-channel maps are only twice as large as one-channel maps",
                             to_text(size) + " times",
                             judge_size(2.0, 3.0, size),
                             "Hair of opacity (0.9, 0.6, 0.35) against hair of opacity 0.6 in one channel.",
                             {size}});
    const bool grey_is_one = light_of(grey).layout.channels == 1;
    report.claims.push_back(
        {"section 5.2",
         "monochrome maps store one channel",
         grey_is_one ? "a grey scene makes a map of one channel" : "a grey scene makes three channels",
         by_construction(grey_is_one),
         "This holds for single pixels too: if the three functions are equal, one is kept.",
         {}});
}

void motion(const Context& context) {
    const base::ThreadLimit threads(context.threads);
    PaperReport& report = *context.report;
    const char* scene = "lokovic2000_motion";
    const std::vector<std::string> no_motion{"/scene/objects/0/motion=[0,0,0]"}, smaller{"rays.resolution=96"};
    std::vector<std::string> still_set = no_motion, moving_set{"reference.spread_seeds=2"};
    still_set.insert(still_set.end(), moving_set.begin(), moving_set.end());
    const results::Result moving = context.run(scene, moving_set, smaller),
                          still = context.run(scene, still_set, smaller);
    const Cell &a = cell_of(light_of(moving), "deep"), &b = cell_of(light_of(still), "deep");
    TimedMaps timed;
    timed.add(context, scene, {}, smaller, 16384);
    timed.add(context, scene, no_motion, smaller, 16384);
    const Compared compared[] = {{0, 1}};
    const Value cost = timed.take(compared).ratio(0, 1), size = bytes_of(a) / bytes_of(b);
    report.claims.push_back(
        {"section 6, figure 12",
         "motion blur costs no more at lookup",
         fmt::format("{} times the time of the still sphere, and {} times its bytes", to_text(cost), to_text(size)),
         judge_constant(cost),
         "A blurred pixel stores a function of more steps, and is searched in the same way.",
         {cost, size}});
}

}  // namespace shadowbench::claims::lokovic
