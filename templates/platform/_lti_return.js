// Goes back at once; the button does the same where no script runs.
document.getElementById("return").submit();
