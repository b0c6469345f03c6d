// Amounts with units, as options give them: "4MiB", "50ns", "5min".
#pragma once

#include <span>
#include <string>

namespace shadowbench::service {

struct Unit {
    const char* name;
    double factor;  // of the amount that is returned
};

inline constexpr Unit byte_units[] = {{"B", 1}, {"KiB", 1024}, {"MiB", 1048576}, {"GiB", 1073741824}};
inline constexpr Unit nanosecond_units[] = {{"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
inline constexpr Unit millisecond_units[] = {{"ns", 1e-6}, {"us", 1e-3}, {"ms", 1}, {"s", 1e3}, {"min", 6e4}};
inline constexpr Unit second_units[] = {{"s", 1}, {"min", 60}, {"h", 3600}};

// A number above 0 and a unit, with or without a space between them. Throws Error{usage}, place `where`, that lists the
// units.
double read_quantity(const std::string& text, std::span<const Unit> units, const std::string& where);

}  // namespace shadowbench::service
