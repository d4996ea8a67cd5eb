// Promises that are handed to who does not wait for them, such as setTimeout, `onclick` or a parameter of unknown type:
// typescript-eslint's own rule sees only those handed to functions that say what they call.

import ts from "typescript";

const HANDED =
  "This may give a promise, and who takes it does not say that it waits for one: write its type, or use start().";
const DEPTH = 3; // of objects within objects

const parts = (type) => (type.isUnionOrIntersection() ? type.types : [type]);
const unknown = (type) => Boolean(type.flags & (ts.TypeFlags.Any | ts.TypeFlags.Unknown));
const isPromise = (type) => parts(type).some((part) => !unknown(part) && part.getProperty("then"));
const givesPromise = (type) =>
  parts(type).some((part) => part.getCallSignatures().some((each) => isPromise(each.getReturnType())));
const isLiteral = (type) =>
  Boolean(type.flags & ts.TypeFlags.Object && type.objectFlags & ts.ObjectFlags.ObjectLiteral);

/** Whether a type is a promise, gives one when it is called, or holds one that does. */
function promises(checker, type, node, depth = DEPTH) {
  if (isPromise(type) || givesPromise(type)) return true;
  if (!depth) return false;
  const inside = parts(type).flatMap((part) => {
    if (checker.isArrayType(part) || checker.isTupleType(part)) return checker.getTypeArguments(part);
    return isLiteral(part) ? part.getProperties().map((each) => checker.getTypeOfSymbolAtLocation(each, node)) : [];
  });
  return inside.some((each) => promises(checker, each, node, depth - 1));
}

/** Whether something of this type may be given a promise: its type says so, or is what it is given. */
function waits(checker, type, node) {
  const open = (each) => Boolean(each.flags & ts.TypeFlags.TypeParameter) || isPromise(each);
  return parts(type).some(
    (part) =>
      open(part) ||
      part.getCallSignatures().some((each) => parts(each.getReturnType()).some(open)) ||
      (!unknown(part) && promises(checker, part, node)),
  );
}

const handed = {
  meta: { type: "problem", schema: [], messages: { handed: HANDED } },
  create(context) {
    const { program, esTreeNodeToTSNodeMap: nodes } = context.sourceCode.parserServices;
    const checker = program.getTypeChecker();
    function check(given, taken) {
      const node = nodes.get(given);
      if (!promises(checker, checker.getTypeAtLocation(node), node)) return;
      const type = taken ? checker.getTypeAtLocation(nodes.get(taken)) : checker.getContextualType(node);
      if (!type || !waits(checker, type, node)) context.report({ node: given, messageId: "handed" });
    }
    return {
      "CallExpression, NewExpression": (call) =>
        call.arguments.forEach((given) => check(given.type === "SpreadElement" ? given.argument : given)),
      AssignmentExpression: ({ left, right }) => check(right, left),
      // What is either unknown or a promise is unknown.
      "LogicalExpression, ConditionalExpression": (whole) => {
        const either = [whole.right, whole.consequent, whole.alternate];
        if (unknown(checker.getTypeAtLocation(nodes.get(whole))))
          either.forEach((given) => given && check(given, whole));
      },
    };
  },
};

export default { rules: { handed } };
