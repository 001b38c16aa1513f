// Pixie: forgets what it keeps of lights. The renderer keeps nothing of them.
void clearlighting() {}
