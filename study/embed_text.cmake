# cmake -DINPUT=page.css -DOUTPUT=page.css.cpp -DROOM=report/html -DNAME=report::kPageCss -P embed_text.cmake
# Writes a source that defines imunoise::NAME, which study/ROOM/assets.h declares, as the text of INPUT.
file(READ "${INPUT}" text)
string(CONCAT source
  "#include \"study/${ROOM}/assets.h\"\n\n"
  "const std::string_view imunoise::${NAME} = R\"asset(" "${text}" ")asset\";\n")
file(WRITE "${OUTPUT}" "${source}")
