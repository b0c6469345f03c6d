// Names after "OpenEXR: Technical Introduction" and "Interpreting OpenEXR Deep Pixels" (Hillman, Welford 2013): a
// channel is "<layer>.<base name>" or a base name. AR, AG and AB are the alpha of one colour each (RA, GA and BA before
// OpenEXR 2); A is the alpha of the colours that have none of their own.
#include "scene/readers/deep_channels.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "scene/readers/read_image.h"

namespace shadowbench::scene {
namespace {

// The channels of a layer by their base names.
using Layer = std::map<std::string, int>;

int index_of(const Layer& layer, const char* name) {
    const auto found = layer.find(name);
    return found == layer.end() ? -1 : found->second;
}

// Some programs write Zback. A back that is passed over would turn volumes into surfaces without a word.
int index_of_back(const Layer& layer) {
    constexpr std::string_view back = "zback";
    const int exact = index_of(layer, "ZBack");
    if (exact >= 0) return exact;
    const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    for (const auto& [name, index] : layer)
        if (std::equal(name.begin(), name.end(), back.begin(), back.end(),
                       [&](char written, char wanted) { return small(written) == wanted; }))
            return index;
    return -1;
}

DeepChannels channels_of(const Layer& layer) {
    DeepChannels channels;
    const int shared = index_of(layer, "A");
    constexpr std::array own{"AR", "AG", "AB"}, older{"RA", "GA", "BA"};
    for (std::size_t c = 0; c < own.size(); ++c) {
        int index = index_of(layer, own[c]);
        if (index < 0) index = index_of(layer, older[c]);
        channels.alpha[c] = index < 0 ? shared : index;
    }
    channels.z = index_of(layer, "Z");
    channels.z_back = index_of_back(layer);
    return channels;
}

bool complete(const DeepChannels& channels) {
    return channels.z >= 0 && channels.alpha[0] >= 0 && channels.alpha[1] >= 0 && channels.alpha[2] >= 0;
}

std::string list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (name.empty() ? "(no layer)" : name);
    return text.empty() ? "none" : text;
}

}  // namespace

DeepChannels find_deep_channels(const std::vector<std::string>& names, const std::optional<std::string>& layer,
                                const std::filesystem::path& file, ReadNotes& notes) {
    std::map<std::string, Layer> layers;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::size_t dot = names[i].rfind('.');
        const bool named = dot != std::string::npos;
        layers[named ? names[i].substr(0, dot) : ""].emplace(named ? names[i].substr(dot + 1) : names[i],
                                                             static_cast<int>(i));
    }
    std::vector<std::string> fit;  // layers; the one without a name first
    for (const auto& [name, channels] : layers)
        if (complete(channels_of(channels))) fit.push_back(name);

    if (layer) {
        if (const auto found = layers.find(*layer); found != layers.end() && complete(channels_of(found->second)))
            return channels_of(found->second);
        refuse_image(file,
                     fmt::format("there is no layer \"{}\" with the channels A and Z; the layers that have them: {}",
                                 *layer, list(fit)));
    }
    if (fit.empty())
        refuse_image(file, fmt::format("the channels A and Z are needed; there are: {}", fmt::join(names, ", ")));
    if (fit.size() > 1 && !fit[0].empty())
        refuse_image(file, fmt::format("{} layers have the channels A and Z: give \"layer\", one of: {}", fit.size(),
                                       list(fit)));
    if (fit.size() > 1)
        notes.lines.push_back(
            fmt::format("the channels without a layer are read; passed over: {}", list({fit.begin() + 1, fit.end()})));
    return channels_of(layers[fit[0]]);
}

}  // namespace shadowbench::scene
