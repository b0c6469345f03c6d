#include "service/store/job_search.h"

#include <locale.h>
#include <wctype.h>

#include <cstddef>

#include "base/utf8.h"
#include "service/store/damaged_store.h"

namespace shadowbench::service {
namespace {

using sqlite::Database, sqlite::Rows, sqlite::Transaction, sqlite::run;

constexpr std::string_view search_sql =
    "CREATE VIRTUAL TABLE jobs_text USING fts5(text, tokenize = 'trigram case_sensitive 1')";

// Of the index that fsck makes for comparison.
constexpr const char* anew_sql = R"(
CREATE VIRTUAL TABLE temp.anew USING fts5(text, content = '', tokenize = 'trigram case_sensitive 1');
INSERT INTO temp.anew (rowid, text) SELECT rowid, text FROM main.jobs_text;
CREATE VIRTUAL TABLE temp.anew_terms USING fts5vocab(temp, anew, instance);
CREATE VIRTUAL TABLE temp.kept_terms USING fts5vocab(main, jobs_text, instance);
)";

constexpr std::string_view texts_sql = "SELECT sequence, id, name, owner, labels, fault_message FROM jobs";
constexpr int first_text = 1, last_text = 5;

constexpr std::string_view replacement = "\xef\xbf\xbd";  // U+FFFD
constexpr std::size_t trigram = 3, longest_phrase = 64;   // characters

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

// What is searched, of the current row of texts_sql: a line for each part, and line breaks around them, so that a label
// or an owner can be looked for as a whole.
std::string searched_text(const Rows& rows) {
    std::string text = "\n";
    for (int column = first_text; column <= last_text; ++column) text += rows.text(column) + '\n';
    return fold_case(text);
}

bool has_search(Database& database) {
    Rows rows(database, "SELECT 1 FROM sqlite_schema WHERE name = 'jobs_text' AND sql = ?", {search_sql});
    return rows.next();
}

// The number of jobs that the index lacks or has with another text, and of texts without a job.
std::size_t count_differences(Database& database) {
    Rows jobs(database, std::string(texts_sql) + " ORDER BY sequence");
    Rows texts(database, "SELECT rowid, text FROM jobs_text ORDER BY rowid");
    std::size_t differences = 0;
    bool job = jobs.next(), text = texts.next();
    while (job || text) {
        const std::int64_t of_job = job ? jobs.integer(0) : INT64_MAX, of_text = text ? texts.integer(0) : INT64_MAX;
        if (of_job != of_text || searched_text(jobs) != texts.text(1)) ++differences;
        if (of_job <= of_text) job = jobs.next();
        if (of_text <= of_job) text = texts.next();
    }
    return differences;
}

// Whether the index has the places of all trigrams of its texts. FTS5's own check needs a connection that writes.
bool has_all_terms(Database& database) {
    database.execute(anew_sql);
    Rows kept(database, "SELECT term, doc, \"offset\" FROM temp.kept_terms");
    Rows anew(database, "SELECT term, doc, \"offset\" FROM temp.anew_terms");
    while (kept.next())
        if (!anew.next() || kept.text(0) != anew.text(0) || kept.integer(1) != anew.integer(1) ||
            kept.integer(2) != anew.integer(2))
            return false;
    return !anew.next();
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

std::string phrase_of(std::string_view folded) {
    std::string phrase = "\"";
    std::size_t characters = 0;
    for (const char byte : folded) {
        const bool begins = (static_cast<unsigned char>(byte) & 0xc0u) != 0x80u;
        if (begins && ++characters > longest_phrase) break;
        phrase += byte;
        if (byte == '"') phrase += byte;
    }
    return characters < trigram ? "" : phrase + '"';
}

void make_search(Database& database) {
    database.execute("DROP TABLE IF EXISTS jobs_text");
    database.execute(std::string(search_sql));
    Rows rows(database, std::string(texts_sql) + " ORDER BY sequence");
    while (rows.next()) {
        const std::string text = searched_text(rows);
        run(database, "INSERT INTO jobs_text (rowid, text) VALUES (?, ?)", {rows.integer(0), text});
    }
}

void index_job(Database& database, const std::string& id) {
    std::int64_t sequence = 0;
    std::string text;
    {
        Rows rows(database, std::string(texts_sql) + " WHERE id = ?", {id});
        if (!rows.next()) return;
        sequence = rows.integer(0);
        text = searched_text(rows);
    }
    {
        Rows rows(database, "SELECT text FROM jobs_text WHERE rowid = ?", {sequence});
        if (rows.next() && rows.text(0) == text) return;
    }
    run(database, "INSERT OR REPLACE INTO jobs_text (rowid, text) VALUES (?, ?)", {sequence, text});
}

void unindex_job(Database& database, const std::string& id) {
    run(database, "DELETE FROM jobs_text WHERE rowid = (SELECT sequence FROM jobs WHERE id = ?)", {id});
}

bool is_search_whole(Database& database) {
    if (!has_search(database)) return false;
    try {
        const Transaction undone(database);
        run(database, "INSERT INTO jobs_text (jobs_text) VALUES ('integrity-check')");
        return count_differences(database) == 0;
    } catch (const DamagedStore&) {
        return false;
    }
}

std::vector<std::string> find_search_faults(Database& database) {
    const auto fault = [](const std::string& what) -> std::vector<std::string> {
        return {"the index of the texts of jobs " + what + "; the next start of the server makes it anew"};
    };
    if (!has_search(database)) return fault("is missing");
    try {
        if (const std::size_t jobs = count_differences(database))
            return fault("is wrong for " + std::to_string(jobs) + " of them");
        if (!has_all_terms(database)) return fault("is damaged");
    } catch (const DamagedStore&) {
        return fault("is damaged");
    }
    return {};
}

}  // namespace shadowbench::service
