// Verdicts of claims of several parts.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "claims/rules.h"

namespace shadowbench::claims {
namespace {

std::string among(const char* which, const Judged& one) {
    return one.limits.empty() ? which : fmt::format("{}: {}", which, one.limits);
}

std::string joined(const std::string& x, const std::string& y, const char* between) {
    return x.empty() || x == y ? y : y.empty() ? x : x + between + y;
}

// From the best to the worst of a claim's parts.
int badness(Verdict verdict) {
    switch (verdict) {
        case Verdict::by_construction:
            return 0;
        case Verdict::holds:
            return 1;
        case Verdict::in_shape:
            return 2;
        case Verdict::not_comparable:
            return 3;
        case Verdict::undecided:  // stands here for nothing: see best_of() and worst_of()
        case Verdict::fails:
            return 4;
    }
    return 4;
}

Verdict better(Verdict a, Verdict b) {
    return badness(a) <= badness(b) ? a : b;
}

Verdict worse(Verdict a, Verdict b) {
    return badness(a) >= badness(b) ? a : b;
}

Verdict best_of(const Judged& one) {
    return one.verdict == Verdict::undecided ? one.best : one.verdict;
}

Verdict worst_of(const Judged& one) {
    return one.verdict == Verdict::undecided ? one.worst : one.verdict;
}

Judged between(Verdict best, Verdict worst, std::string rule, std::string limits) {
    return {best == worst ? best : Verdict::undecided, std::move(rule), std::move(limits), best, worst};
}

using Verdicts = std::vector<Verdict>;

Verdict most_have(const Verdicts& cases) {
    for (const Verdict verdict : {Verdict::holds, Verdict::in_shape}) {
        const auto as_good = std::count_if(cases.begin(), cases.end(),
                                           [&](Verdict one) { return badness(one) <= badness(verdict); });
        if (2 * static_cast<std::size_t>(as_good) > cases.size()) return verdict;
    }
    return Verdict::fails;
}

Verdict all_have(const Verdicts& cases) {
    const Verdict worst = *std::max_element(cases.begin(), cases.end(),
                                            [](Verdict a, Verdict b) { return badness(a) < badness(b); });
    return worst == Verdict::fails && most_have(cases) == Verdict::holds ? Verdict::in_shape : worst;
}

Verdict any_has(const Verdicts& cases) {
    return *std::min_element(cases.begin(), cases.end(),
                             [](Verdict a, Verdict b) { return badness(a) < badness(b); });
}

// What a function of decided verdicts gives, from all parts at their best to all at their worst: it never gives a
// better verdict for a worse part.
Judged over_parts(Verdict (*of)(const Verdicts&), const std::vector<Judged>& parts, const char* which) {
    Verdicts best, worst;
    for (const Judged& one : parts) {
        best.push_back(best_of(one));
        worst.push_back(worst_of(one));
    }
    return between(of(best), of(worst), parts.front().rule, among(which, parts.front()));
}

}  // namespace

Judged both(const Judged& a, const Judged& b) {
    return between(worse(best_of(a), best_of(b)), worse(worst_of(a), worst_of(b)), joined(a.rule, b.rule, ", "),
                   joined(a.limits, b.limits, "; "));
}

Judged in_most(const std::vector<Judged>& cases) {
    return over_parts(most_have, cases, "in most");
}

Judged in_all(const std::vector<Judged>& cases) {
    return over_parts(all_have, cases, "in all");
}

Judged in_any(const std::vector<Judged>& cases) {
    return over_parts(any_has, cases, "in any");
}

Judged in_readings(const std::vector<Judged>& readings) {
    Judged judged = readings.front();
    const Judged* last = &readings.front();
    Verdict best = best_of(*last), worst = worst_of(*last);
    for (const Judged& one : readings) {
        best = better(best, best_of(one));
        worst = worse(worst, worst_of(one));
        if (one.rule != last->rule) judged.rule = joined(judged.rule, one.rule, ", ");
        if (one.limits != last->limits) judged.limits = joined(judged.limits, one.limits, "; ");
        last = &one;
    }
    return between(best, worst, judged.rule, among("in all readings", judged));
}

}  // namespace shadowbench::claims
