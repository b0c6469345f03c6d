// How fast this machine is, for estimates.
#pragma once

namespace shadowbench::bench {

// The time of a fixed small piece of work over its time on the machine that work.cpp takes its seconds from: the
// least of several tries, which take some hundredths of a second.
double measure_pace();

}  // namespace shadowbench::bench
