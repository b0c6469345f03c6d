// The same random cases in every run, so that a failure here is a failure everywhere. RC_PARAMS overrides.
#include <gtest/gtest.h>

#include <cstdlib>

namespace {

class FixedSeed : public testing::Environment {
public:
    void SetUp() override { setenv("RC_PARAMS", "seed=20000723 max_success=10000", 0); }
};

const testing::Environment* const fixed_seed = testing::AddGlobalTestEnvironment(new FixedSeed);

}  // namespace
