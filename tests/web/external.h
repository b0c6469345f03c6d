// What a file would load from another place.
#pragma once

#include <regex>
#include <string>
#include <vector>

namespace shadowbench::service {

// Addresses with a host in it, but for the names of XML namespaces, which nobody loads.
inline std::vector<std::string> external_addresses(const std::string& text) {
    static const std::regex address("(https?:)?//[a-zA-Z0-9-]+\\.[a-zA-Z0-9./-]+");
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), address), end; it != end; ++it) {
        const std::string one = it->str();
        if (one.rfind("http://www.w3.org/", 0) != 0) found.push_back(one);
    }
    return found;
}

}  // namespace shadowbench::service
