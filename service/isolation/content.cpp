#include "service/isolation/content.h"

#include <variant>

namespace shadowbench::service {

using techniques::Description;
using techniques::NodeStats;
using techniques::OutsideParameter;
using techniques::OutsideTrade;
using techniques::ParameterValues;

namespace {

template <class Item>
std::span<const Item> all_of(const std::vector<Item>& items) {
    return items;
}

}  // namespace

void put(MessageWriter& to, const Description& description) {
    for (const std::string* text : {&description.id, &description.title, &description.paper}) to.put_text(*text);
    to.put(description.version);
    to.put(description.cells);
    to.put(description.promises);
    to.put(static_cast<std::uint64_t>(description.parameters.size()));
    for (const OutsideParameter& p : description.parameters) {
        for (const std::string* text : {&p.name, &p.doc, &p.standard_word}) to.put_text(*text);
        to.put(p.kind);
        for (const double number : {p.standard, p.min, p.max}) to.put(number);
        to.put(static_cast<std::uint64_t>(p.words.size()));
        for (const std::string& word : p.words) to.put_text(word);
    }
    to.put(static_cast<std::uint64_t>(description.trades.size()));
    for (const OutsideTrade& trade : description.trades) {
        to.put_text(trade.parameter);
        to.put(trade.scale);
        to.put(trade.from);
        to.put(trade.to);
    }
}

Description get_description(MessageReader& from) {
    Description description;
    for (std::string* text : {&description.id, &description.title, &description.paper}) *text = from.get_text();
    description.version = from.get<int>();
    description.cells = from.get<techniques::Cells>();
    description.promises = from.get<techniques::Promises>();
    for (std::size_t left = from.get_count(); left > 0; --left) {
        OutsideParameter& p = description.parameters.emplace_back();
        for (std::string* text : {&p.name, &p.doc, &p.standard_word}) *text = from.get_text();
        p.kind = from.get<techniques::ParameterKind>();
        for (double* number : {&p.standard, &p.min, &p.max}) *number = from.get<double>();
        for (std::size_t words = from.get_count(); words > 0; --words) p.words.push_back(from.get_text());
    }
    for (std::size_t left = from.get_count(); left > 0; --left) {
        OutsideTrade& trade = description.trades.emplace_back();
        trade.parameter = from.get_text();
        trade.scale = from.get<techniques::Trade::Scale>();
        trade.from = from.get<double>();
        trade.to = from.get<double>();
    }
    return description;
}

void put(MessageWriter& to, const ParameterValues& values) {
    to.put(static_cast<std::uint64_t>(values.values.size()));
    for (const auto& [name, value] : values.values) {
        const double* number = std::get_if<double>(&value);
        to.put_text(name);
        to.put(number ? *number : 0.0);
        to.put(static_cast<char>(number ? 0 : 1));
        to.put_text(number ? "" : std::get<std::string>(value));
    }
}

ParameterValues get_values(MessageReader& from) {
    ParameterValues values;
    for (std::size_t left = from.get_count(); left > 0; --left) {
        const std::string name = from.get_text();
        const auto number = from.get<double>();
        const bool is_word = from.get<char>() != 0;
        std::string word = from.get_text();
        values.values[name] = is_word ? ParameterValues::Value(std::move(word)) : ParameterValues::Value(number);
    }
    return values;
}

void put(MessageWriter& to, const rays::LightRays& tile) {
    for (const int number : {tile.tile, tile.x0, tile.y0, tile.width, tile.height, tile.samples, tile.channels})
        to.put(number);
    to.put_list(all_of(tile.begin));
    to.put_list(all_of(tile.z_front));
    to.put_list(all_of(tile.z_back));
    to.put_list(all_of(tile.transmittance));
}

rays::LightRays get_rays(MessageReader& from) {
    rays::LightRays tile;
    for (int* number : {&tile.tile, &tile.x0, &tile.y0, &tile.width, &tile.height, &tile.samples, &tile.channels})
        *number = from.get<int>();
    from.get_list(tile.begin);
    from.get_list(tile.z_front);
    from.get_list(tile.z_back);
    from.get_list(tile.transmittance);
    return tile;
}

void put(MessageWriter& to, const NodeStats& stats) {
    to.put(stats.cells);
    to.put(stats.total);
    to.put(stats.max);
    to.put_list(all_of(stats.histogram));
}

NodeStats get_nodes(MessageReader& from) {
    NodeStats stats;
    stats.cells = from.get<std::uint64_t>();
    stats.total = from.get<std::uint64_t>();
    stats.max = from.get<std::uint32_t>();
    from.get_list(stats.histogram);
    return stats;
}

}  // namespace shadowbench::service
