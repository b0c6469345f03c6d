#pragma once

namespace shadowbench::service {

// The text of openapi.json, as it was when the program was built.
const char* openapi_text();

}  // namespace shadowbench::service
