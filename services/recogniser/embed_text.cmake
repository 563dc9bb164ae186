# cmake -DIN=FILE -DOUT=FILE.cc -DNAME=kName -P embed_text.cmake: a text file as a C++ string.
file(READ ${IN} text)
file(WRITE ${OUT} "namespace visavis {\nextern const char* const ${NAME};\nconst char* const ${NAME} = R\"text(${text})text\";\n}  // namespace visavis\n")
