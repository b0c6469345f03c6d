// Pictures of one scene through several techniques, side by side on one sheet.
#pragma once

#include <string>
#include <vector>

#include "claims/paper.h"

namespace shadowbench::claims {

// Renders scenarios/papers/<name>.json with these changes. Above, from left to right: the reference, then each
// technique's picture; below: the reference's visibility alone, then each technique's difference from the reference,
// times four. A technique that fails leaves its column out and is named in the caption.
Sheet picture_sheet(const Context& context, const std::string& name, const std::vector<std::string>& set);

}  // namespace shadowbench::claims
