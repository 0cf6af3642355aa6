// cli/shared/source_names.h -- decides whether the words of a command line mean files or a domain
// of the cache.
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
    std::vector<std::string> files;  // empty: the words name a domain
    std::string domain;              // empty: no domain was named
};

// Sorts the words. A word is a path if it has a slash, is "-", or names an existing file or
// directory. Any other word is a domain. `domain` is the value of --domain. Errors: bad_argument
// for a word that is both a domain (`is_domain` returns true) and a file; the message says how to
// write each. bad_argument for files together with a domain, and for several domains. not_found for
// a word that looks like a file but does not exist.
[[nodiscard]] Result<SourceNames> tell_apart(
    const std::vector<std::string>& words, const std::string& domain,
    const std::function<bool(const std::string&)>& is_domain);

}  // namespace stormcellar::cli
