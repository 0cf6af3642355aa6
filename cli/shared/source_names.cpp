#include "cli/shared/source_names.h"

#include <algorithm>
#include <filesystem>

#include "stormcellar/archive/archive_reader.h"

namespace stormcellar::cli {
namespace {

bool exists(const std::string& word) {
    std::error_code ignored;
    return std::filesystem::exists(word, ignored);
}

bool is_path(const std::string& word) {
    return word == "-" || word.find('/') != std::string::npos || exists(word) ||
           archive::member_path_of(word);
}

// Returns true if the word looks like a file. Names of raw files have a date or an ending; names of
// domains seldom do.
bool looks_like_a_file(const std::string& word) {
    const auto digits = std::ranges::count_if(word, [](char c) { return c >= '0' && c <= '9'; });
    return digits >= 8 || word.ends_with(".gz") || word.ends_with(".bz2") ||
           word.ends_with(".ar2v") || word.ends_with(".tar") || word.ends_with(".zip");
}

}  // namespace

Result<SourceNames> tell_apart(const std::vector<std::string>& words, const std::string& domain,
                               const std::function<bool(const std::string&)>& is_domain) {
    SourceNames names;
    names.domain = domain;
    for (const std::string& word : words) {
        if (is_path(word)) {
            if (word.find('/') == std::string::npos && word != "-" && is_domain(word)) {
                return fail(ErrorCode::bad_argument,
                            "'{0}' is a file here and a domain of the cache; write ./{0} for the "
                            "file, or --domain {0} for the domain",
                            word);
            }
            names.files.push_back(word);
        } else if (looks_like_a_file(word) || words.size() > 1) {
            return fail(ErrorCode::not_found, "{}: there is no such file or directory", word);
        } else if (!names.domain.empty()) {
            return fail(ErrorCode::bad_argument, "there are two domains, '{}' and '{}'; name one",
                        names.domain, word);
        } else {
            names.domain = word;
        }
    }
    if (!names.files.empty() && !names.domain.empty()) {
        return fail(ErrorCode::bad_argument,
                    "a picture is drawn from files or from a domain of the cache; name only one "
                    "of '{}' and '{}'",
                    names.files.front(), names.domain);
    }
    return names;
}

}  // namespace stormcellar::cli
