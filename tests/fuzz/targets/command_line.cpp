#include <nlohmann/json.hpp>

#include "bench/functions.h"
#include "document/document.h"
#include "document/technique_choice.h"
#include "fuzz/expect.h"
#include "fuzz/few_variants.h"
#include "fuzz/target.h"

namespace shadowbench::fuzz {
namespace {

nlohmann::json some_document() {
    return nlohmann::json::parse(R"({
        "name": "ball", "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1}]},
        "lights": [{"type": "directional", "direction": [0, -1, 0]}], "rays": {"resolution": 8},
        "techniques": [{"type": "deep"}, {"type": "avsm", "nodes": 4}],
        "sweeps": {"/rays/samples_per_pixel": [1, 2], "/techniques/1/nodes": [4, 8]}})");
}

}  // namespace

// Lines that begin with ':' are values of --technique, the others of --set, in order.
void command_line(std::string_view bytes) {
    const auto codes = {base::ErrorCode::usage, base::ErrorCode::bad_input};
    nlohmann::json document = some_document();
    while (!bytes.empty()) {
        const std::string line(take_line(bytes));
        if (line.starts_with(':'))
            attempt(codes, [&] { document::read_any_technique(line.substr(1)); });
        else
            attempt(codes, [&] { document::set_value(document, line); });
    }
    if (!few_variants(document)) return;
    attempt(codes, [&] {
        for (const document::Variant& variant : document::expand(document))
            expect(!variant.document->contains("sweeps"), "a variant has no sweeps");
        expect(nlohmann::json::parse(document.dump()) == document, "a valid document can be written");
    });
}

}  // namespace shadowbench::fuzz
