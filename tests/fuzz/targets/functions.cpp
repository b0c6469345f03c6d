#include "curves/functions_file.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "curves/curve.h"
#include "fuzz/expect.h"
#include "fuzz/target.h"

namespace shadowbench::fuzz {
namespace {

void expect_sound(const curves::Curve& function) {
    for (std::size_t i = 0; i < function.size(); ++i) {
        expect(std::isfinite(function[i].z), "depths are finite");
        expect(i == 0 || function[i - 1].z <= function[i].z, "depths do not decrease");
    }
    expect(curves::is_visibility(function), "values are in [0, 1] and do not increase");
}

}  // namespace

void functions(std::string_view bytes) {
    const InputFile file(bytes, ".txt");
    attempt({base::ErrorCode::bad_input}, [&] {
        const std::vector<curves::Curve> read = curves::read_functions(file.path());
        for (const curves::Curve& function : read) expect_sound(function);
        const InputFile copy("", ".copy");
        curves::write_functions(copy.path(), read);
        expect(curves::read_functions(copy.path()) == read, "what is written is read back");
    });
}

}  // namespace shadowbench::fuzz
