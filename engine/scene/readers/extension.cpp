#include "scene/readers/extension.h"

#include <cstddef>

#include <fmt/format.h>

#include "scene/readers/text_lines.h"

namespace shadowbench::scene {

std::string extension_of(const std::filesystem::path& file) {
    return lower_case(file.extension().string());
}

std::string unknown_extension(const std::filesystem::path& file, std::string_view kind,
                              const std::vector<std::string_view>& known) {
    std::string list;
    for (std::size_t i = 0; i < known.size(); ++i)
        list.append(i == 0 ? "" : i + 1 < known.size() ? ", " : " or ").append(known[i]);
    const std::string extension = file.extension().string();
    return fmt::format("the name of a {} file must end in {}{}", kind, list,
                       extension.empty() ? "" : fmt::format("; {} is not read", extension));
}

}  // namespace shadowbench::scene
