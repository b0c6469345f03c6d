// A data file in words, for people.
#pragma once

#include <string>

#include "scene/data_file.h"

namespace shadowbench::scene {

// Its kind, counts, box, ranges of values, and what its reader passed over. Printable; every line is ended.
std::string describe_file(const DataFile& data);

}  // namespace shadowbench::scene
