#pragma once

namespace shadowbench::bench {

struct BuildInfo {
    const char* version;
    const char* commit;  // short hash; "+changes" behind it when the engine's files differed from it
    const char* compiler;
    const char* build_type;
};

// Of this binary.
BuildInfo build_info();

}  // namespace shadowbench::bench
