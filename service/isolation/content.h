// What messages hold: descriptions, parameters, rays and counts.
#pragma once

#include "service/isolation/message.h"
#include "techniques/external/description.h"
#include "techniques/technique.h"

namespace shadowbench::service {

void put(MessageWriter& to, const techniques::Description& description);
techniques::Description get_description(MessageReader& from);

void put(MessageWriter& to, const techniques::ParameterValues& values);
techniques::ParameterValues get_values(MessageReader& from);

void put(MessageWriter& to, const rays::LightRays& tile);
rays::LightRays get_rays(MessageReader& from);

void put(MessageWriter& to, const techniques::NodeStats& stats);
techniques::NodeStats get_nodes(MessageReader& from);

}  // namespace shadowbench::service
