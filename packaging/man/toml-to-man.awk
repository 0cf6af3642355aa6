# Turns the explained configuration (daemon/stormcellard.toml) into the body of its manual page:
#   [table]           a heading
#   comment lines     text about the key or table that follows; lines indented by three or more blanks
#                     are examples and stay unchanged; a [[table]] among them becomes a heading
#   key = value       the key, its default, and the comment above it
function roff(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    if (text ~ /^[.']/) text = "\\&" text
    return text
}
function plain_text(    i, line, inside, name) {
    if (count == 0) return
    name = ""
    for (i = count; i > 0; --i) {
        if (comment[i] ~ /^  \[\[/) name = substr(comment[i], 3)
    }
    print name == "" ? ".PP" : ".SH \"" roff(name) "\""
    inside = 0
    for (i = 1; i <= count; ++i) {
        line = comment[i]
        if (line ~ /^  /) {
            if (!inside) print ".PP\n.RS\n.nf"
            inside = 1
            print roff(substr(line, 3))
            continue
        }
        if (inside && line == "") { print ""; continue }
        if (inside) print ".fi\n.RE\n.PP"
        inside = 0
        print line == "" ? ".PP" : roff(line)
    }
    if (inside) print ".fi\n.RE"
    count = 0
}
/^#/ {
    line = $0
    sub(/^# ?/, "", line)
    # The file's first line is its name.
    if (NR > 1) comment[++count] = line
    next
}
/^\[/ {
    plain_text()
    table = $0
    print ".SH \"" roff(table) "\""
    next
}
/=/ {
    key = $0
    value = $0
    sub(/ *=.*/, "", key)
    sub(/^[^=]*= */, "", value)
    print ".TP\n\\fB" roff(key) "\\fR = " roff(value)
    # Keep the paragraphs of the comment in the key's item of the list.
    for (i = 1; i <= count; ++i) print comment[i] == "" ? ".IP" : roff(comment[i])
    count = 0
    next
}
# A blank line after a comment: the comment explains no key, so print it as a paragraph.
/^$/ { if (count > 0) plain_text() }
END { plain_text() }
