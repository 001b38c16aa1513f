/* Calls in orders that nobody should use: orders CASE. Ends with the last error as its status; prints what the program's own
 * handler got. */
#include <ri.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

static int handled;
static jmp_buf back;

static RtVoid count(RtInt code, RtInt severity, char* message) {
    printf("%d %d %s\n", (int)code, (int)severity, message);
    handled++;
}
static RtVoid leave(RtInt code, RtInt severity, char* message) {
    (void)severity;
    (void)message;
    longjmp(back, (int)code);
}

int main(int argc, char** argv) {
    const char* what = argc > 1 ? argv[1] : "";
    if (strcmp(what, "nobody") == 0) { /* no RiBegin */
        RiErrorHandler(count);
        RiSphere(1, -1, 1, 360, RI_NULL);
        RiEnd();
        RiObjectInstance(0);
    } else if (strcmp(what, "abort") == 0) { /* the third line is not reached */
        RiErrorHandler(RiErrorAbort);
        RiBegin(RI_NULL);
        RiAttributeEnd();
        printf("still here\n");
    } else if (strcmp(what, "ignore") == 0) {
        RiErrorHandler(RiErrorIgnore);
        RiBegin(RI_NULL);
        RiAttributeEnd();
        RiEnd();
    } else if (strcmp(what, "print") == 0) {
        RiBegin(RI_NULL);
        RiAttributeEnd();
        RiEnd();
    } else if (strcmp(what, "leave") == 0) { /* a handler that does not come back */
        int code;
        RiErrorHandler(leave);
        RiBegin(RI_NULL);
        code = setjmp(back);
        if (code == 0) RiAttributeEnd();
        printf("left with %d\n", code);
        RiErrorHandler(count);
        RiEnd();
    } else if (strcmp(what, "open") == 0) { /* no RiEnd, a world open */
        RiBegin(RI_NULL);
        RiWorldBegin();
    } else if (strcmp(what, "command") == 0) {
        RiErrorHandler(count);
        RiBegin("|touch made");
        RiEnd();
    } else {
        return 100;
    }
    printf("handled %d\n", handled);
    return RiLastError;
}
