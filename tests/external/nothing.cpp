// A shared library without techniques.
extern "C" int nothing_of_use() {
    return 0;
}
