#include "claims/words.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>

#include "claims/rules.h"

namespace shadowbench::claims {
namespace {

TEST(Words, AreEachNamedOnceWithRulesOfTheTable) {
    std::set<std::string> ids, words;
    for (const Rule& rule : all_rules()) ids.insert(rule.id);
    for (const Word& word : all_words()) {
        EXPECT_TRUE(words.insert(word.words).second) << word.words;
        EXPECT_FALSE(std::string(word.note).empty()) << word.words;
        std::istringstream list(word.rules);
        for (std::string id; std::getline(list, id, ',');) {
            if (id.starts_with(' ')) id.erase(0, 1);
            EXPECT_TRUE(ids.count(id)) << word.words << ": " << id;
        }
    }
}

}  // namespace
}  // namespace shadowbench::claims
