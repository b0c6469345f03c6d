// Sheets: pictures of one scene through several techniques, side by side.
#pragma once

#include <string>
#include <vector>

#include "claims/paper.h"

namespace shadowbench::claims {

// Renders scenarios/papers/<name>.json with these changes. Upper row, from left to right: the reference, then each
// technique's picture, all at the exposure that suits the reference. Lower row: the reference's visibility, then each
// technique's difference from the reference, times four, dark on white. A technique that fails has no column; the
// caption names it. The file is named after the paper, with `suffix`.
Sheet picture_sheet(const Context& context, const std::string& name, const std::vector<std::string>& set,
                    const std::string& suffix = "");

}  // namespace shadowbench::claims
