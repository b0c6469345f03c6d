#include "techniques/external/load.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"

namespace shadowbench::techniques {
namespace {

using base::Error;
using base::ErrorCode;

bool is_there(const std::string& id) {
    return std::any_of(all().begin(), all().end(), [&](const Technique& row) { return id == row.id; });
}

std::vector<Technique> rows_of(const std::filesystem::path& file, const Opener& open) {
    const OpenLibrary library = open(file);
    std::vector<Technique> rows;
    for (const Outside& technique : library.techniques) {
        if (is_there(technique.description.id))
            throw Error(ErrorCode::bad_input, file.string(),
                        "there is a technique \"" + technique.description.id + "\" already; give it another id");
        rows.push_back(make_row(technique, library.library));
    }
    return rows;
}

}  // namespace

void load_library(const std::filesystem::path& file, const Opener& open) {
    const Library library = identify(file);
    for (const Technique& row : all())
        if (row.library.file == library.file && row.library.hash == library.hash) return;
    std::vector<Technique> rows;
    try {
        rows = rows_of(file, open);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::bad_input && error.code() != ErrorCode::internal) throw;
        const std::string id = id_of_file(file);
        if (is_there(id)) throw Error(ErrorCode::bad_input, file.string(), error.message());
        rows.push_back(make_broken_row(id, library, error.message()));
    }
    for (Technique& row : rows) add(std::move(row), file.string());
}

}  // namespace shadowbench::techniques
