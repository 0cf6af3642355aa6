#include "level2/decode/problem_notes.h"

#include <fmt/format.h>

namespace stormcellar::level2 {

std::vector<std::string> notes_of(const DecodeReport& report) {
    constexpr std::size_t most_problems_noted = 20;
    std::vector<std::string> notes;
    for (const Problem& problem : report.problems) {
        if (notes.size() == most_problems_noted) {
            notes.push_back(
                fmt::format("and {} more problems", report.problems.size() - notes.size()));
            break;
        }
        notes.push_back(problem.text());
    }
    return notes;
}

}  // namespace stormcellar::level2
