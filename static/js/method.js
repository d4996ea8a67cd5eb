// A method page.

import { offerCopies } from "./copy.js";

offerCopies(document);
