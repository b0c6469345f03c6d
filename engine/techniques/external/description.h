// What a technique from outside says of itself, and the row of the registry that is made of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "techniques/external/calls.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

// As Parameter and Trade, with texts of its own.
struct OutsideParameter {
    std::string name, doc;
    ParameterKind kind = ParameterKind::number;
    double standard = 0.0, min = 0.0, max = 0.0;
    std::string standard_word;
    std::vector<std::string> words;
};
struct OutsideTrade {
    std::string parameter;
    Trade::Scale scale = Trade::Scale::linear;  // choice: every word of the parameter
    double from = 0.0, to = 0.0;
};

struct Description {
    std::string id, title, paper;
    int version = 1;
    Cells cells = Cells::none;
    Promises promises;
    std::vector<OutsideParameter> parameters;
    std::vector<OutsideTrade> trades;
};

// Throws Error{bad_input}, place `where`, for a description that a row cannot have, such as a default out of range.
void check_description(const Description& description, const std::string& where);

// A technique from outside, described and ready to be called.
struct Outside {
    Description description;
    std::shared_ptr<TechniqueCalls> calls;
};

// The row of a technique. What its library does wrong fails the maps of this row: see Map::fault.
Technique make_row(const Outside& technique, const Library& library);

// A row in place of the techniques of a library that cannot be used: its maps fail with this reason.
Technique make_broken_row(const std::string& id, const Library& library, const std::string& reason);

}  // namespace shadowbench::techniques
