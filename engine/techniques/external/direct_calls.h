// Calls the functions of a library in this process.
#pragma once

#include <memory>
#include <string>

#include "techniques/external/calls.h"
#include "techniques/external/description.h"
#include "techniques/external/shadowbench_technique.h"

namespace shadowbench::techniques {

// `technique` outlives the result. Faults have the place `file`.
std::shared_ptr<TechniqueCalls> call_directly(const shadowbench_technique& technique, const Description& description,
                                              const std::string& file);

}  // namespace shadowbench::techniques
