// stormcellar/base/member_name.h -- how a member of an archive is named:
// "DIR/a.tar!KTLX20170101_030027_V06".
//
// A mark inside a name proves nothing: files may have it, too. Whether an archive stands there, who
// asks must see.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace stormcellar {

inline constexpr char member_mark = '!';

struct MemberName {
    std::filesystem::path archive;
    std::string member;
};

// What the path may mean, the shortest archive's name first; nothing where it has no mark.
[[nodiscard]] inline std::vector<MemberName> member_names_in(const std::filesystem::path& path) {
    std::vector<MemberName> names;
    const std::string& text = path.native();
    for (std::size_t at = text.find(member_mark); at != std::string::npos;
         at = text.find(member_mark, at + 1)) {
        if (at > 0 && at + 1 < text.size())
            names.push_back({text.substr(0, at), text.substr(at + 1)});
    }
    return names;
}

[[nodiscard]] inline std::filesystem::path member_path(const std::filesystem::path& archive,
                                                       const std::string& member) {
    return archive.native() + member_mark + member;
}

}  // namespace stormcellar
