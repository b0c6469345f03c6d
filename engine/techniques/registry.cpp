// The registry, made from rows.inc, which has one line for each technique.
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/nearest.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

#define ROW(name) Technique name();
#include "techniques/rows.inc"
#undef ROW

namespace {

std::deque<Technique>& rows() {
    static std::deque<Technique> rows = {
#define ROW(name) name(),
#include "techniques/rows.inc"
#undef ROW
    };
    return rows;
}

}  // namespace

const std::deque<Technique>& all() {
    return rows();
}

void add(Technique row, const std::string& where) {
    for (const Technique& other : all())
        if (std::string(other.id) == row.id)
            throw base::Error(base::ErrorCode::bad_input, where,
                              "there is a technique \"" + std::string(row.id) + "\" already" +
                                  (other.library.file.empty() ? "" : ", from " + other.library.file));
    rows().push_back(std::move(row));
}

const Technique& find(const std::string& id, const std::string& where) {
    std::string names;
    std::vector<std::string> ids;
    for (const Technique& row : all()) {
        if (id == row.id) return row;
        names += (names.empty() ? "" : ", ") + std::string(row.id);
        ids.push_back(row.id);
    }
    throw base::Error(base::ErrorCode::bad_input, where,
                      "unknown technique \"" + id + "\"" + base::perhaps(id, ids) + "; there are: " + names);
}

void NodeStats::add(std::uint32_t nodes) {
    ++cells;
    total += nodes;
    if (nodes >= histogram.size()) histogram.resize(nodes + 1, 0);
    ++histogram[nodes];
    if (nodes > max) max = nodes;
}

}  // namespace shadowbench::techniques
