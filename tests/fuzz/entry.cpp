// The entry point of libFuzzer. SHADOWBENCH_FUZZ_TARGET names the target.
#include <cstddef>
#include <cstdint>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
    shadowbench::fuzz::SHADOWBENCH_FUZZ_TARGET({reinterpret_cast<const char*>(bytes), count});
    return 0;
}
