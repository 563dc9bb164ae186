// Gives the precompiled header of all tests a target to belong to: see tests/CMakeLists.txt.
