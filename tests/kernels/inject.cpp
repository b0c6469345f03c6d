#include "kernels/inject.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace shadowbench::kernels {
namespace {

constexpr std::array<std::pair<const char*, Fault>, 4> names{
    {{"slow", Fault::slow}, {"node", Fault::node}, {"byte", Fault::byte}, {"error", Fault::error}}};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
    throw std::invalid_argument("--inject=" + text + ": " + why +
                                "; as in slow:compress/hair:0.10 or error:build/:1e-3");
}

Fault read_fault(const std::string& text, const std::string& name) {
    for (const auto& [known, fault] : names)
        if (name == known) return fault;
    refuse(text, "there is no fault \"" + name + "\" (slow, node, byte, error)");
}

double read_amount(const std::string& text, const std::string& number) {
    try {
        std::size_t used = 0;
        const double amount = std::stod(number, &used);
        if (used == number.size() && std::isfinite(amount) && amount >= 0.0) return amount;
    } catch (const std::logic_error&) {
    }
    refuse(text, "\"" + number + "\" is not an amount");
}

void add(std::optional<double>& to, double amount) {
    if (to) *to += amount;
}

}  // namespace

Injection read_injection(const std::string& text) {
    // The expression may contain colons, as names do.
    const std::size_t first = text.find(':'), last = text.rfind(':');
    if (first == last) refuse(text, "it is not FAULT:REGEX:AMOUNT");
    const Fault fault = read_fault(text, text.substr(0, first));
    const double amount = read_amount(text, text.substr(last + 1));
    try {
        return {fault, std::regex(text.substr(first + 1, last - first - 1)), amount, text};
    } catch (const std::regex_error&) {
        refuse(text, "the expression is not valid");
    }
}

Faults faults_of(const std::string& kernel, std::span<const Injection> injections) {
    Faults faults;
    for (const Injection& injection : injections) {
        if (!std::regex_search(kernel, injection.names)) continue;
        switch (injection.fault) {
            case Fault::slow:
                faults.slow += injection.amount;
                break;
            case Fault::node:
                faults.nodes += injection.amount;
                break;
            case Fault::byte:
                faults.bytes += injection.amount;
                break;
            case Fault::error:
                faults.error += injection.amount;
                break;
        }
    }
    return faults;
}

Exact with(Exact exact, const Faults& faults) {
    add(exact.nodes, faults.nodes);
    add(exact.bytes, faults.bytes);
    add(exact.error, faults.error);
    add(exact.lookup_error, faults.error);
    return exact;
}

}  // namespace shadowbench::kernels
