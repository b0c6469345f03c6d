#include "bench/fake_map.h"

#include "base/error.h"

namespace shadowbench::bench {

void FakeMap::begin(const techniques::BuildInput&) {
    if (answers_.refuses_begin) throw base::Error(base::ErrorCode::bad_input, "", "this layout is not for me");
}

const techniques::Technique& fake_technique() {
    static const techniques::Technique row{
        "fake",
        "for tests",
        "none",
        1,
        {},
        {},
        [](const techniques::ParameterValues&) -> std::unique_ptr<techniques::Map> {
            return std::make_unique<FakeMap>(fake_answers);
        },
        [](const techniques::ParameterValues&, const rays::MapLayout&) { return fake_answers.error_bound; },
        nullptr,
        [](const techniques::ParameterValues&, const rays::MapLayout&) { return std::size_t{100}; },
        false,
        [](const techniques::ParameterValues&) { return fake_answers.promises; }};
    return row;
}

}  // namespace shadowbench::bench
