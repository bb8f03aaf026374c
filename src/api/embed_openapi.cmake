# Writes openapi.yaml into a C++ file: cmake -DOUTPUT=… -DINPUT=… -P embed_openapi.cmake
file(READ ${INPUT} yaml)
file(WRITE ${OUTPUT} "// Generated from openapi.yaml by embed_openapi.cmake.\n#include \"api/openapi.hpp\"\n\nnamespace linefeed::api {\n\n")
file(APPEND ${OUTPUT} "const std::string_view openapi_text = R\"linefeed_yaml(${yaml})linefeed_yaml\";\n\n} // namespace linefeed::api\n")
