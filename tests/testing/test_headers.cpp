// Holds the precompiled headers of the tests; the program itself does nothing.
int main() {
    return 0;
}
