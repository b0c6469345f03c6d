#include "service/store/job_texts.h"

#include <locale.h>
#include <wctype.h>

#include <algorithm>
#include <exception>
#include <initializer_list>
#include <utility>

#include "base/utf8.h"
#include "service/store/job_rows.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows;

constexpr std::string_view texts_sql =
    "SELECT sequence, id, name, owner, labels, fault_message FROM jobs WHERE sequence > ? ORDER BY sequence LIMIT ?";
constexpr std::int64_t rows_at_once = 500;

constexpr std::string_view replacement = "\xef\xbf\xbd";  // U+FFFD
constexpr std::size_t longest_kept = 1000;                // bytes of a text

// The character of a well-formed sequence of UTF-8, of more than one byte.
wint_t character_of(std::string_view sequence) {
    wint_t character = static_cast<unsigned char>(sequence[0]) & (0x7fu >> sequence.size());
    for (const char byte : sequence.substr(1)) character = character << 6 | (static_cast<unsigned char>(byte) & 0x3fu);
    return character;
}

void append(std::string& text, wint_t character) {
    const auto rest = [&](int shift) { text += static_cast<char>(0x80u | (character >> shift & 0x3fu)); };
    if (character < 0x80) {
        text += static_cast<char>(character);
    } else if (character < 0x800) {
        text += static_cast<char>(0xc0u | character >> 6);
        rest(0);
    } else if (character < 0x10000) {
        text += static_cast<char>(0xe0u | character >> 12);
        rest(6);
        rest(0);
    } else {
        text += static_cast<char>(0xf0u | character >> 18);
        rest(12);
        rest(6);
        rest(0);
    }
}

// Some letters, such as sigma, have two lower cases with one upper case.
wint_t fold_character(wint_t character) {
    static const locale_t unicode = ::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
    return unicode ? ::towlower_l(::towupper_l(character, unicode), unicode) : character;
}

std::string searched(std::initializer_list<std::string_view> parts) {
    std::string text = "\n";
    for (const std::string_view part : parts) text.append(part) += '\n';
    return fold_case(text);
}

std::string kept(std::string text) {
    if (text.size() > longest_kept) text.resize(longest_kept);
    text.shrink_to_fit();
    return text;
}

}  // namespace

std::string fold_case(std::string_view text) {
    std::string folded;
    folded.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = base::utf8_sequence(text);
        const char first = text[0];
        if (length == 0 || first == '\0')
            folded += replacement;
        else if (length == 1)
            folded += first >= 'A' && first <= 'Z' ? static_cast<char>(first - 'A' + 'a') : first;
        else
            append(folded, fold_character(character_of(text.substr(0, length))));
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return folded;
}

std::string searched_text(const StoredJob& job) {
    return searched({job.id, job.name, job.owner, join_labels(job.labels), job.fault ? job.fault->message : ""});
}

void JobTexts::load(Database& rows) {
    for (;;) {
        // A job that changes meanwhile is set after this, or was changed before and is read here.
        const std::scoped_lock lock(mutex_);
        if (loaded_ == INT64_MAX) return;
        Rows some(rows, texts_sql, {loaded_, rows_at_once});
        std::int64_t count = 0, last = loaded_;
        for (; some.next(); ++count) {
            last = some.integer(0);
            texts_[last] = kept(searched({some.text(1), some.text(2), some.text(3), some.text(4), some.text(5)}));
        }
        loaded_ = count < rows_at_once ? INT64_MAX : last;
    }
}

void JobTexts::set(std::int64_t sequence, std::string text) noexcept {
    const std::scoped_lock lock(mutex_);
    try {
        if (text.empty())
            texts_.erase(sequence);
        else if (sequence <= loaded_)
            texts_[sequence] = kept(std::move(text));
    } catch (const std::exception&) {
        // No memory is left. The job is changed all the same, and the next search reads its text.
        texts_.clear();
        loaded_ = 0;
    }
}

std::vector<std::int64_t> JobTexts::find(const std::vector<std::string>& parts, std::int64_t before,
                                         std::size_t most) const {
    // Writers wait for no more than some texts.
    constexpr int at_a_time = 4096;
    std::vector<std::int64_t> found;
    std::unique_lock lock(mutex_);
    int looked_at = 0;
    for (auto at = texts_.lower_bound(before); at != texts_.begin() && found.size() < most;) {
        --at;
        if (++looked_at % at_a_time == 0) {
            const std::int64_t here = at->first;
            lock.unlock();
            lock.lock();
            at = texts_.upper_bound(here);
            if (at == texts_.begin()) break;
            --at;
        }
        const auto has = [&](const std::string& part) { return at->second.find(part) != std::string::npos; };
        if (at->second.size() >= longest_kept || std::all_of(parts.begin(), parts.end(), has))
            found.push_back(at->first);
    }
    return found;
}

}  // namespace shadowbench::service
