# cmake -DINPUT=page.css -DOUTPUT=page.css.cpp -DSYMBOL=kPageCss -P embed_text.cmake
# Writes a source that defines SYMBOL as the text of INPUT.
file(READ "${INPUT}" text)
string(CONCAT source
  "#include \"study/report/assets.h\"\n\n"
  "const std::string_view imunoise::report::${SYMBOL} = R\"asset(" "${text}" ")asset\";\n")
file(WRITE "${OUTPUT}" "${source}")
