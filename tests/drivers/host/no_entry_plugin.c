/* A shared object that is no driver. */
extern int imunoise_is_not_here(void);
int imunoise_is_not_here(void) { return 1; }
