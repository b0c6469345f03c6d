// A deep shadow map file in words.
#pragma once

#include <string>

namespace shadowbench::techniques {
class DeepFile;
}

namespace shadowbench::service {

// What the header says and what the tiles hold. Reads and so checks every tile; throws what that throws.
std::string describe(const techniques::DeepFile& file, const std::string& name);

}  // namespace shadowbench::service
