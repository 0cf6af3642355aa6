// render/image/xmp.h -- writes the metadata of pictures as text, and as XMP for JPEG and WebP.
//
// Source    ISO 16684-1 (XMP), with Dublin Core properties as language alternatives.
// Threads   Pure functions.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stormcellar::render {

using PictureTexts = std::vector<std::pair<std::string, std::string>>;  // keywords and texts

// Returns all texts as one text, such as "Title: KTLX\nSource: ...".
[[nodiscard]] std::string text_of(const PictureTexts& texts);
// Returns the text of the keyword "Title". It may be empty.
[[nodiscard]] std::string title_of(const PictureTexts& texts);

// Returns the text as the content of an XML element. Replaces control characters, which XML 1.0
// forbids, by blanks.
[[nodiscard]] std::string xml_escaped(std::string_view text);

// Returns an XMP packet, with the title as dc:title and all texts as dc:description.
[[nodiscard]] std::string xmp_packet(const PictureTexts& texts);

}  // namespace stormcellar::render
