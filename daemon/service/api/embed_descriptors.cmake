# cmake -DINPUT=service.binpb -DOUTPUT=descriptors.cpp -P embed_descriptors.cmake
# Writes a source that holds the bytes of INPUT.
file(READ "${INPUT}" bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
string(REGEX REPLACE "(('.x..',){20})" "\\1\n" bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include \"daemon/service/api/descriptors.h\"\n\n"
  "namespace {\nconstexpr char kBytes[] = {\n${bytes}};\n}  // namespace\n\n"
  "std::string_view imunoise::service::descriptor_set() { return {kBytes, sizeof kBytes}; }\n")
