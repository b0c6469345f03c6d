// The papers' words, and the rules that judge them: the same in all papers. The report prints this table.
#pragma once

#include <span>

namespace shadowbench::claims {

struct Word {
    const char* words;  // of the papers
    const char* rules;  // ids, joined by commas
    const char* note;   // "-" if there is none
};
std::span<const Word> all_words();

}  // namespace shadowbench::claims
