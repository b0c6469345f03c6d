// Describes a deep shadow map file as text.
#pragma once

#include <string>

namespace shadowbench::techniques {
class DeepFile;
}

namespace shadowbench::service {

// The facts of the header, and of each level the nodes and bytes of its tiles. Reads, and so checks, every tile. Throws
// what DeepFile::read_tile() throws.
std::string describe(const techniques::DeepFile& file, const std::string& name);

}  // namespace shadowbench::service
