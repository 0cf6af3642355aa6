// cli/shared/source_names.h -- whether the words of a command line are files or a domain of the
// cache.
//
// Threads   Pure functions, which look at the file system.
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

// A word with a slash in it is a path, and so are "-" and a word that names a file or a directory
// that exists. Any other word is a domain. `domain` is that of --domain. Errors: bad_argument,
// saying how to write each, for a word that `is_domain` says is one and that names a file too, for
// files beside a domain, and for several domains; not_found for what looks like the name of a file
// that does not exist.
[[nodiscard]] Result<SourceNames> tell_apart(
    const std::vector<std::string>& words, const std::string& domain,
    const std::function<bool(const std::string&)>& is_domain);

}  // namespace stormcellar::cli
