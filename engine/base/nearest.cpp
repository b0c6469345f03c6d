#include "base/nearest.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace shadowbench::base {
namespace {

constexpr std::size_t longest_word = 64;  // a longer one is no slip of the fingers

// The optimal string alignment distance, row by row.
std::size_t edits(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        before_last.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

}  // namespace

std::string nearest(const std::string& word, std::span<const std::string> names) {
    if (word.size() > longest_word) return "";
    // A third of the letters may be wrong: closer words are likely typing errors, others are different words.
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    std::string found;
    for (const std::string& name : names) {
        if (name.size() > longest_word) continue;
        const std::size_t distance = edits(word, name);
        if (distance >= least) continue;
        least = distance;
        found = name;
    }
    return found;
}

std::string perhaps(const std::string& word, std::span<const std::string> names) {
    const std::string name = nearest(word, names);
    return name.empty() ? "" : ", perhaps \"" + name + "\"";
}

}  // namespace shadowbench::base
