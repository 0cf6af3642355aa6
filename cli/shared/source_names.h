// cli/shared/source_names.h -- decides whether the words of a command line are files or a domain of
// the cache.
//
// Threads   Pure functions, except that they look at the file system.
// Errors    See tell_apart().
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::cli {

struct SourceNames {
    std::vector<std::string> files;  // empty: a domain is meant
    std::string domain;              // empty: none was named
};

// Sorts the words. A word is a path if it has a slash, is "-", or names an existing file or
// directory. Any other word is a domain. `domain` is the value of --domain. Errors: bad_argument
// for a word that is both a domain (by `is_domain`) and a file, with the way to write each;
// bad_argument for files together with a domain, and for several domains; not_found for a word that
// looks like a file that does not exist.
[[nodiscard]] Result<SourceNames> tell_apart(
    const std::vector<std::string>& words, const std::string& domain,
    const std::function<bool(const std::string&)>& is_domain);

}  // namespace stormcellar::cli
