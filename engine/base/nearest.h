// Which known name a misspelt one may mean.
#pragma once

#include <span>
#include <string>

namespace shadowbench::base {

// The name that takes the fewest edits to write: a letter too many, a letter too few, another letter, or two neighbours
// swapped. Of several the first; empty if all take more than a third of the word's letters, and more than one.
std::string nearest(const std::string& word, std::span<const std::string> names);

// ", perhaps \"deep\"", for a message about an unknown word; empty if no name is near.
std::string perhaps(const std::string& word, std::span<const std::string> names);

}  // namespace shadowbench::base
