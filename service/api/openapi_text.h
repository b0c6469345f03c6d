// The description of the API, openapi.json, which the program holds.
#pragma once

namespace shadowbench::service {

// The text of openapi.json at the time of the build.
const char* openapi_text();

}  // namespace shadowbench::service
