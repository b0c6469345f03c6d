#include "service/cli/output.h"

#include <nlohmann/json.hpp>

#include "service/cli/terminal.h"

namespace shadowbench::service {

Output::Output(const OutputArguments& arguments, bool several, std::ostream& out, std::ostream& err)
    : arguments_(arguments),
      several_(several),
      out_(out),
      text_(arguments.json || arguments.csv || arguments.quiet ? nowhere_ : out),
      progress_(arguments.quiet ? nowhere_ : err),
      style_(table_style(out)) {}

void Output::print_table(const results::Result& result) {
    text_ << (arguments_.wide ? results::to_table(result) : results::to_fitting_table(result, style_)) << std::flush;
}

void Output::keep(const std::string& json, const std::string& csv) {
    json_ += (json_.empty() ? "" : ",\n") + json;
    csv_ += csv_.empty() ? csv : csv.substr(csv.find('\n') + 1);  // one header
}

void Output::add(const results::Result& result) {
    print_table(result);
    keep(arguments_.json ? results::to_json(result).dump(1) : "", arguments_.csv ? results::to_csv(result) : "");
}

void Output::add(const results::Merged& merged) {
    print_table(merged.result);
    text_ << results::machines_text(merged);
    keep(arguments_.json ? results::to_json(merged).dump(1) : "", arguments_.csv ? results::to_csv(merged) : "");
}

void Output::explain(const results::Result& result) {
    text_ << results::meaning_text(result, style_);
}

void Output::end() {
    if (arguments_.json && several_) out_ << "[" + json_ + "]\n";
    if (arguments_.json && !several_ && !json_.empty()) out_ << json_ + "\n";
    if (arguments_.csv) out_ << csv_;
    out_ << std::flush;
}

}  // namespace shadowbench::service
