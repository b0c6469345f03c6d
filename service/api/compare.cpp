#include "service/api/compare.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#if __has_include("compare/report.h")
#include "compare/compare.h"
#include "compare/measured.h"
#include "compare/report.h"
#endif

namespace shadowbench::service {

using base::Error;
using base::ErrorCode;

#if __has_include("compare/report.h")

namespace {

compare::Measured read_side(const nlohmann::json& result, const char* where) {
    compare::Measured measured;
    if (!compare::add(measured, result, "")) throw Error(ErrorCode::bad_input, where, "this is no result");
    return measured;
}

}  // namespace

nlohmann::ordered_json compare_results(const nlohmann::json& baseline, const nlohmann::json& current) {
    return compare::to_json(compare::compare(read_side(baseline, "/baseline"), read_side(current, "/current"), {}));
}

#else

nlohmann::ordered_json compare_results(const nlohmann::json&, const nlohmann::json&) {
    throw Error(ErrorCode::usage, "compare", "this program was built without engine/compare");
}

#endif

}  // namespace shadowbench::service
