#include "techniques/external/library.h"

#include <dlfcn.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash_text.h"
#include "base/printable.h"
#include "base/read_text.h"
#include "techniques/external/direct_calls.h"
#include "techniques/external/shadowbench_technique.h"

namespace shadowbench::techniques {
namespace {

using base::Error;
using base::ErrorCode;

constexpr const char* entry = "shadowbench_techniques";
constexpr std::size_t longest_text = 1000, most_items = 64, most_words = 256;

// Reads what a library describes. Every fault is bad_input at the library's file.
class Reader {
public:
    explicit Reader(std::string file) : file_(std::move(file)) {}

    [[noreturn]] void refuse(const std::string& why) const { throw Error(ErrorCode::bad_input, file_, why); }

    std::string text(const char* from, const char* what) const {
        if (!from) refuse(fmt::format("{} is a null pointer", what));
        const std::size_t length = ::strnlen(from, longest_text + 1);
        if (length > longest_text) refuse(fmt::format("{} has more than {} characters", what, longest_text));
        return base::printable({from, length});
    }

    template <class Item>
    std::span<const Item> list(const Item* first, std::size_t count, std::size_t most, const char* what) const {
        if (count > most) refuse(fmt::format("it declares {} {}; at most {} are read", count, what, most));
        if (count > 0 && !first) refuse(fmt::format("it declares {} {}, and no list of them", count, what));
        return {first, count};
    }

    OutsideParameter parameter(const shadowbench_parameter& from) const {
        OutsideParameter read;
        read.name = text(from.name, "the name of a parameter");
        read.doc = text(from.doc, "the text of a parameter");
        if (from.kind < SHADOWBENCH_NUMBER || from.kind > SHADOWBENCH_NUMBER_OR_WORD)
            refuse(fmt::format("parameter {} has the kind {}, which there is not", read.name, from.kind));
        constexpr ParameterKind kinds[] = {ParameterKind::number, ParameterKind::integer, ParameterKind::choice,
                                           ParameterKind::number_or_word};
        read.kind = kinds[from.kind];
        read.standard = from.standard;
        read.min = from.min;
        read.max = from.max;
        if (from.standard_word) read.standard_word = text(from.standard_word, "a default");
        for (const char* word : list(from.words, from.word_count, most_words, "words"))
            read.words.push_back(text(word, "a word"));
        return read;
    }

    OutsideTrade trade(const shadowbench_trade& from) const {
        if (from.scale < SHADOWBENCH_LINEAR || from.scale > SHADOWBENCH_WORDS)
            refuse(fmt::format("a trade has the scale {}, which there is not", from.scale));
        constexpr Trade::Scale scales[] = {Trade::Scale::linear, Trade::Scale::logarithmic, Trade::Scale::choice};
        return {text(from.parameter, "the parameter of a trade"), scales[from.scale], from.from, from.to};
    }

    Description technique(const shadowbench_technique& from) const {
        Description read;
        read.id = text(from.id, "the id of a technique");
        read.title = text(from.title, "the title of a technique");
        read.paper = text(from.paper, "the paper of a technique");
        read.version = from.version;
        if (from.cells < SHADOWBENCH_CELL_PIXEL || from.cells > SHADOWBENCH_CELL_NONE)
            refuse(fmt::format("technique {} has cells of kind {}, which there is not", read.id, from.cells));
        constexpr Cells cells[] = {Cells::pixel, Cells::sample, Cells::centre, Cells::none};
        read.cells = cells[from.cells];
        const shadowbench_promises& p = from.promises;
        read.promises = {
            p.monotone != 0, p.unit_range != 0, p.opaque_only != 0, p.localised != 0, p.approximate != 0, p.early != 0,
            p.leak};
        for (const shadowbench_parameter& one : list(from.parameters, from.parameter_count, most_items, "parameters"))
            read.parameters.push_back(parameter(one));
        for (const shadowbench_trade& one : list(from.trades, from.trade_count, most_items, "trades"))
            read.trades.push_back(trade(one));
        const bool complete = from.create && from.destroy && from.add && from.finish && from.lookup && from.bytes;
        if (!complete)
            refuse(fmt::format(
                "technique {} lacks a function: create, destroy, add, finish, lookup and bytes are needed", read.id));
        if (!from.stored && read.cells != Cells::none)
            refuse(fmt::format("technique {} lacks the function stored, which its cells need", read.id));
        return read;
    }

private:
    std::string file_;
};

using Entry = const shadowbench_library* (*)();

const shadowbench_library& enter(Entry function, const Reader& reader) {
    const shadowbench_library* library = nullptr;
    try {
        library = function();
    } catch (...) {
        reader.refuse(fmt::format("{}() threw an exception", entry));
    }
    if (!library) reader.refuse(fmt::format("{}() returned a null pointer", entry));
    return *library;
}

void check_version(const shadowbench_library& library, const Reader& reader) {
    if (library.abi != SHADOWBENCH_TECHNIQUE_ABI)
        reader.refuse(
            fmt::format("it is made for version {} of shadowbench_technique.h, and this program for {}; "
                        "compile it with the header of this program",
                        library.abi, SHADOWBENCH_TECHNIQUE_ABI));
    if (library.technique_size != sizeof(shadowbench_technique))
        reader.refuse(
            fmt::format("its struct shadowbench_technique has {} bytes instead of {}; compile it with the "
                        "header of this program",
                        library.technique_size, sizeof(shadowbench_technique)));
    if (library.technique_count == 0) reader.refuse("it has no techniques");
}

}  // namespace

Library identify(const std::filesystem::path& file) {
    return {file.filename().string(), base::hash_text(base::read_bytes(file))};
}

OpenLibrary open_library(const std::filesystem::path& file) {
    OpenLibrary open{identify(file), {}};
    const Reader reader(file.string());
    // A path with a slash, so that the loader does not search its own folders.
    void* handle = ::dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        const char* why = ::dlerror();
        reader.refuse(fmt::format("it is not a shared library that can be loaded: {}", why ? why : "no reason given"));
    }
    // It stays open: rows point into it. A library is opened once, and the process ends with it.
    const auto function = reinterpret_cast<Entry>(::dlsym(handle, entry));
    if (!function)
        reader.refuse(
            fmt::format("it does not export {}(); include shadowbench_technique.h, and define the function "
                        "with C linkage",
                        entry));
    const shadowbench_library& library = enter(function, reader);
    check_version(library, reader);
    std::set<std::string> ids;
    for (const shadowbench_technique& technique :
         reader.list(library.techniques, library.technique_count, most_items, "techniques")) {
        Description description = reader.technique(technique);
        check_description(description, file.string());
        if (!ids.insert(description.id).second) reader.refuse("two of its techniques are \"" + description.id + "\"");
        auto calls = call_directly(technique, description, open.library.file);
        open.techniques.push_back({std::move(description), std::move(calls)});
    }
    return open;
}

std::string id_of_file(const std::filesystem::path& file) {
    std::string name = file.filename().string();
    name = name.substr(0, name.find('.'));
    if (name.rfind("lib", 0) == 0) name.erase(0, 3);
    std::string id;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        id += byte < 0x80 && std::isalnum(byte) ? static_cast<char>(std::tolower(byte)) : '_';
    }
    if (id.empty() || std::isalpha(static_cast<unsigned char>(id[0])) == 0) id = "library_" + id;
    return id.substr(0, 64);
}

}  // namespace shadowbench::techniques
