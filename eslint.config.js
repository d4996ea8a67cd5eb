// What holds for every script of the pages: a promise that nobody waits for, or whose failure nobody sees, is an error.

import eslint from "@eslint/js";
import tseslint from "typescript-eslint";
import promises from "./lint/promises.js";

export default tseslint.config({
  files: ["static/js/**/*.js"],
  extends: [eslint.configs.recommended, tseslint.configs.base],
  languageOptions: { parserOptions: { projectService: true, tsconfigRootDir: import.meta.dirname } },
  plugins: { promises },
  rules: {
    "no-undef": "off", // tsconfig.json knows the browser's names
    "@typescript-eslint/no-floating-promises": ["error", { ignoreVoid: false }],
    "@typescript-eslint/no-misused-promises": "error",
    "promises/called": "error",
    "promises/handed": "error",
  },
});
