// A technique with its parameters, as a command line names it: "deep:tolerance=0.02,filter=point".
#pragma once

#include <string>

#include "techniques/technique.h"

namespace shadowbench::document {

struct TechniqueChoice {
    const techniques::Technique* row = nullptr;
    techniques::ParameterValues values;
};

// Throws Error{usage}, place "--technique TEXT".
TechniqueChoice read_any_technique(const std::string& text);
// Accepts only techniques that can be built from given functions.
TechniqueChoice read_technique(const std::string& text);

}  // namespace shadowbench::document
