#include "service/api/compare.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "compare/compare.h"
#include "compare/measured.h"
#include "compare/report.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

compare::Measured read_side(const nlohmann::json& result, const char* where) {
    compare::Measured measured;
    if (!compare::add(measured, result, "")) throw Error(ErrorCode::bad_input, where, "not a result of run");
    return measured;
}

}  // namespace

nlohmann::ordered_json compare_results(const nlohmann::json& baseline, const nlohmann::json& current) {
    return compare::to_json(compare::compare(read_side(baseline, "/baseline"), read_side(current, "/current"), {}));
}

}  // namespace shadowbench::service
