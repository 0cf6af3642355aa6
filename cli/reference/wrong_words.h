// cli/reference/wrong_words.h -- explains in one line why the parser refused a command line.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/reference/reference.h"

namespace CLI {
class ParseError;
}

namespace stormcellar::cli {

// Returns a message such as "there is no command 'fram'; did you mean 'frame'?", also for "catalog
// lits".
[[nodiscard]] std::string no_command(const std::string& name, const CommandReference& program);

// Returns the reason why the parser refused the words after this command. `left` are the words that
// the parser did not accept.
[[nodiscard]] std::string reason_of(const CLI::ParseError& error, std::vector<std::string> left,
                                    const CommandReference& command);

}  // namespace stormcellar::cli
