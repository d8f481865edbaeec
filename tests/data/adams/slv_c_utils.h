/* The part of the interface of Adams that a GFOSUB uses, as published; written for these tests. */
struct sAdamsGforce { int ID; int NPAR; const double *PAR; int I; int RM; int JFLOAT; };
typedef void adams_c_Gfosub(const struct sAdamsGforce *, double, int, int, double *);
void c_sysary(const char *name, const int *markers, int size, double *values, int *count, int *error);
void c_errmes(int error, const char *text, int id, const char *action);
