#include "claims/words.h"

namespace shadowbench::claims {
namespace {

constexpr Word words[] = {
    {"less, faster, better, more expensive", "less", "A direction without a size."},
    {"significantly less, faster or more expensive; considerably; significant deviations", "significant",
     "More than slightly. Deviations are significant beside those that are not."},
    {"much less, much better, much faster or longer, much more efficient or expensive, dramatically", "much less", "-"},
    {"eliminates an artifact", "much less", "What is left of it must be much less than what was there."},
    {"slightly more expensive", "less, constant", "More, and at most as much more as constant allows."},
    {"slightly better", "less", "As for a gain: to be clearly better fulfils it."},
    {"virtually constant, at no extra cost", "constant", "-"},
    {"grows, rapidly; softer", "growth", "-"},
    {"grows slowly; O(x^p)", "bound", "A law that the paper derives or plots, and not only bounds, is an exponent."},
    {"an order of magnitude, one to two orders", "gain", "Of at least 10."},
    {"negligible", "negligible", "-"},
    {"imperceptible, little perceptible difference, identical, not noticeable", "unnoticed",
     "Of pictures, or of what is seen in them. The offset of a boundary is not a difference of colours: see offset."},
    {"visible artifacts", "visible", "-"},
    {"substantial artifacts", "visible, much less", "Visible, and much larger than those of the paper's method."},
    {"closely, almost exactly, similar: of curves", "fit", "-"},
    {"looks like, similar results: of pictures", "likeness", "-"},
    {"similar, about as long: of times and costs", "ratio",
     "Of 1, or of the value that the paper gives."},
    {"as good, the same accuracy, no better, no worse", "alike", "What is no worse may also be better."},
    {"acceptable", "not comparable", "No paper says what it accepts."},
};

}  // namespace

std::span<const Word> all_words() {
    return words;
}

}  // namespace shadowbench::claims
