# Writes a C++ file with the text of PAGE, the player of viewer/.
file(READ ${PAGE} text)
string(LENGTH "${text}" length)
set(code "// Generated from viewer/dist/viewer.html.\n#include \"view_pages.hpp\"\n\n")
string(APPEND code "namespace polhode::cli {\n\nconst char* viewer_text() {\n  return\n")
# Compilers take texts of 64 KB at most: long ones are written in pieces, which the compiler joins.
set(begin 0)
while(begin LESS length)
  string(SUBSTRING "${text}" ${begin} 8000 piece)
  string(APPEND code "R\"viewer(${piece})viewer\"\n")
  math(EXPR begin "${begin} + 8000")
endwhile()
string(APPEND code ";\n}\n\n}  // namespace polhode::cli\n")
file(WRITE ${OUTPUT} "${code}")
