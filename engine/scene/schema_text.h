// The scenario schema as a string in the program.
#pragma once

namespace shadowbench::scene {

// The text of scenario.schema.json, as it was when the program was built.
const char* scenario_schema_text();

}  // namespace shadowbench::scene
